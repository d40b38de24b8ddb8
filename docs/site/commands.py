# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# The options of the commands, from their own --help.
import re
import subprocess


def help_of(command, *words):
    return subprocess.run([command, *words, "--help"], text=True, capture_output=True,
                          check=True).stdout


def names_of(text):
    """The commands that the help of all lists."""
    section = text[text.index("\nSubcommands:") if "\nSubcommands:" in text else text.index("\nCommands:"):]
    return re.findall(r"^  ([a-z]+) ", section, re.M)


def write(stage, command):
    overall = help_of(command)
    text = ("# Options\n\nWhat every command's `--help` says; [commands](commands.md) says what each is for. Files and columns are in [formats](formats.md), what "
            "`--json` writes in [JSON keys](json.md).\n\n"
            f"```text\n{overall.strip()}\n```\n")
    for name in names_of(overall):
        text += f"\n## {name}\n\n```text\n{help_of(command, name).strip()}\n```\n"
    stage.write("options", text)
