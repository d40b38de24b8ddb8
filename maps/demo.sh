#!/bin/sh
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# Runs the worked examples with the command in build/ (see 'make demo').
set -eu
cd "$(dirname "$0")/.."

build/trussmap --version
