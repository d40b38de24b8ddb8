# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# A short way to the usual things; CMake does the work (see CMakePresets.json).
#   make               configure and build into build/
#   make demo          install what is missing (Debian), build the command, run the worked example
#                      (VERBOSE=1: with every command's tables)
#   make check         install what is missing (Debian), look whether the sources are formatted, build
#                      everything, run the fast tests: those of pages in a browser and the slow ones
#                      are left to make test
#   make format        format the sources (clang-format)
#   make test          the same with all tests; pages are tested in a browser (Chromium), which is
#                      installed too, as are, where there is npm, what checks their scripts' types
#                      and their accessibility
#   make package       install what is missing, build the Debian packages into build/package and
#                      check them (lintian); make dist: the archive of the sources alone
#   make python        install what is missing, build the Python package into build/python
#   make notebooks     the same, then execute docs/notebooks into build/notebooks (installs Jupyter's parts)
#   make fuzz          every reader under a fuzzer for MINUTES=1 each (clang); what fails is kept in
#                      tests/fuzz/found, where make test replays it
#   make tsan          the tests of threads under ThreadSanitizer
#   make site          the documentation as a site, build/site/html/index.html (installs Sphinx and its like)
#   make site-check    run what the pages show: every block of commands
#   make install-deps  install the Debian packages that the build needs
#   make clean         remove the build trees
JOBS ?= $(shell nproc 2>/dev/null || echo 2)

# A tree keeps the generator that it was first configured with, and whether it compiles the
# sources of a folder as one (UNITY=OFF: who works on them).
UNITY ?= ON
ifeq ($(wildcard build/CMakeCache.txt),)
GENERATOR = $(shell command -v ninja >/dev/null 2>&1 && echo -G Ninja) -D TRUSSMAP_UNITY=$(UNITY)
endif

MINUTES ?= 1
PYTHON_TREE ?= build
# Debian's, where there is one: its packages are installed for it, whatever else the PATH has.
PYTHON ?= $(firstword $(wildcard /usr/bin/python3) python3)
.PHONY: all check formatted format demo test dist package site site-check python notebooks fuzz tsan install-deps test-deps site-deps configure build command clean
.NOTPARALLEL:

all: build

configure:
	@command -v cmake >/dev/null || { echo "cmake is missing: run 'make install-deps'" >&2; exit 1; }
	@cmake --preset default $(GENERATOR) >/dev/null

build: configure
	@cmake --build build --parallel $(JOBS)

command: configure
	@cmake --build build --parallel $(JOBS) --target trussmap_command

demo: install-deps command
	@maps/demo.sh $(if $(VERBOSE),--verbose)

check: install-deps formatted build
	@.ci/test build --parallel $(JOBS) --label-exclude 'slow|browser'

# In an archive of the sources, which is no repository, there is nothing to look at.
formatted:
	@.ci/install-deps clang-format git
	@git ls-files '*.hpp' '*.cpp' 2>/dev/null | xargs -r clang-format --dry-run -Werror || \
	  { echo "not as clang-format has it: make format" >&2; exit 1; }

format:
	@.ci/install-deps clang-format git
	@git ls-files '*.hpp' '*.cpp' | xargs clang-format -i

test: test-deps build
	@.ci/test build --parallel $(JOBS)

site: site-deps command
	@docs/site/build.py build/trussmap build/site

site-check: install-deps command
	@PYTHONPATH=$(abspath $(PYTHON_TREE))/python:$$PYTHONPATH $(PYTHON) docs/site/run_blocks.py build/trussmap

dist:
	@packaging/make_package dist

package: install-deps
	@.ci/install-deps python3-dev python3-numpy python3-pybind11 pybind11-dev debhelper dh-python dpkg-dev lintian git
	@packaging/make_package package

python:
	@.ci/install-deps python3-dev python3-numpy python3-pybind11 pybind11-dev
	@cmake --preset default $(GENERATOR) -B $(PYTHON_TREE) -D TRUSSMAP_BUILD_PYTHON=ON -D Python_EXECUTABLE=$(PYTHON) >/dev/null
	@cmake --build $(PYTHON_TREE) --parallel $(JOBS) --target trussmap_python_package trussmap_command

notebooks: python
	@.ci/install-deps python3-matplotlib python3-nbclient python3-nbconvert python3-nbformat python3-ipykernel
	@$(PYTHON) docs/notebooks/execute.py --package $(PYTHON_TREE)/python build/notebooks

fuzz:
	@.ci/install-deps clang libclang-rt-dev
	@CC=clang CXX=clang++ cmake --preset fuzz $(GENERATOR) >/dev/null
	@cmake --build build-fuzz --parallel $(JOBS)
	@tests/fuzz/run build-fuzz $(MINUTES)

tsan: install-deps
	@cmake --preset tsan $(GENERATOR) >/dev/null
	@cmake --build build-tsan --parallel $(JOBS) --target trussmap_thread_tests
	@OPENBLAS_NUM_THREADS=1 .ci/test build-tsan

install-deps:
	@.ci/install-deps

test-deps:
	@.ci/install-deps chromium
	@.ci/page-tools build/page-tools

site-deps:
	@.ci/install-deps python3-sphinx python3-myst-parser furo python3-breathe doxygen libjs-katex nodejs \
	  codespell aspell aspell-en patch python3-jsonschema

clean:
	rm -rf build build-*
