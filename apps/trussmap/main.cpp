// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include <cstdio>
int main() {
  std::puts("trussmap");
}
