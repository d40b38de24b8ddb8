#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# Spelling of the pages: common misspellings anywhere (codespell), and in prose every word that
# neither the dictionary (aspell, British English) nor words.txt has.
import re
import subprocess
import sys
import tomllib

sys.dont_write_bytecode = True  # nothing is left beside the sources

from pages import HERE, TOP, Contents, without_code

EFFECTS = TOP / "src/effects/catalogue"
WORDS = HERE / "words.txt"


def prose_of(path):
    """Text without code, links' targets and names of files."""
    text = "".join(line for line, prose in without_code(path.read_text()) if prose)
    text = re.sub(r"<!--.*?-->", " ", text, flags=re.S)
    text = re.sub(r"\$\$.*?\$\$|\$[^$\n]+\$", " ", text, flags=re.S)
    text = re.sub(r"``.*?``|`[^`]*`", " ", text)
    text = re.sub(r"\]\([^)]*\)", "] ", text)
    text = re.sub(r"<[^>]*>", " ", text)
    text = re.sub(r"https?://\S+", " ", text)
    return re.sub(r"[\w./-]*[_/][\w./-]*", " ", text)


def texts_of_effects():
    """By file."""
    for path in sorted(EFFECTS.glob("*.toml")):
        effect = tomllib.loads(path.read_text())
        told = effect["explanation"]
        text = " ".join([effect["cause"], effect["remedy"], told["does"], told["look"], told["drive"],
                         told.get("otherwise", ""), effect["gallery"]["happens"],
                         effect["gallery"]["look"]])
        yield path, re.sub(r"`[^`]*`|\{\}|\]\([^)]*\)", " ", text)


def unknown(text):
    """Words that no list has. Plurals and other endings are the dictionary's affair."""
    known = set(WORDS.read_text().lower().split())
    ran = subprocess.run(["aspell", "list", "--lang=en_GB", "--encoding=utf-8"], input=text,
                         text=True, capture_output=True, check=True)
    words = {word.removesuffix("'s").removesuffix("'") for word in ran.stdout.split()}
    return sorted(word for word in words if word.lower() not in known)


def check(contents, names=None):
    """Ends the program where a word is wrong."""
    wrong = []
    files = [TOP / path for name, path in contents.files.items()
             if name not in ("changelog", "errata", "benchmarks")]
    for path in files:
        for word in unknown(prose_of(path)):
            wrong.append(f"{path.relative_to(TOP)}: {word}")
    for path, text in texts_of_effects():
        wrong += [f"{path.relative_to(TOP)}: {word}" for word in unknown(text)]
    everything = [str(TOP / path) for path in contents.files.values()]
    everything += [str(path) for path in EFFECTS.glob("*.toml")]
    ran = subprocess.run(["codespell", "--ignore-words", str(HERE / "not-misspelt.txt"), *everything],
                         text=True, capture_output=True)
    wrong += ran.stdout.splitlines()
    if wrong:
        sys.exit("spelling (words that are right go into docs/site/words.txt):\n" + "\n".join(wrong))


if __name__ == "__main__":
    check(Contents())
