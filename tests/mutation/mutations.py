# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""What can be changed in a source: one operator, sign, constant or branch at a time.

Sources are formatted, so that spaces tell a binary operator from a sign, a pointer or a template.
"""
import re
from dataclasses import dataclass

SWAPS = {
    "+": ["-"], "-": ["+"], "*": ["/"], "/": ["*"],
    "+=": ["-="], "-=": ["+="], "*=": ["/="], "/=": ["*="],
    "<": ["<=", ">"], "<=": ["<"], ">": [">=", "<"], ">=": [">"], "==": ["!="], "!=": ["=="],
    "&&": ["||"], "||": ["&&"],
}
OPERATOR = re.compile(
    r"(?<=\S )(%s)(?=\s)" % "|".join(re.escape(op) for op in sorted(SWAPS, key=len, reverse=True)))
SIGN = re.compile(r"(?<![\w)\]\x01-])-(?=[\w(.])")
COUNT_UP = re.compile(r"(?<=\s)\+\+(?=[\w.>\[\]()-]+;)")
NUMBER = re.compile(r"(?<![\w.])(\d[\d']*(?:\.\d*)?(?:[eE][+-]?\d+)?)([uUlLzZ]*)(?![\w.])")
TRUTH = re.compile(r"\b(true|false)\b")
BRANCH = re.compile(r"^[ ]*(?:\} )?(?:else )?(if|while) \(", re.MULTILINE)
GUARD = re.compile(r" (?:continue|break|return\b[^;{]*);")
HIDDEN = "\x01"  # stands for what is left alone


@dataclass(frozen=True)
class Mutation:
    """`new` instead of text[begin:end]."""
    kind: str
    begin: int
    end: int
    new: str


def hide(text, begin, end, by=HIDDEN):
    kept = "".join("\n" if c == "\n" else by for c in text[begin:end])
    return text[:begin] + kept + text[end:]


def without_comments_and_strings(text):
    token = re.compile(
        r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"' r"|(?<!\w)'(?:\\.|[^'\\])+'",
        re.DOTALL)

    def hidden(match):
        by = " " if match[0].startswith("/") else HIDDEN
        return "".join("\n" if c == "\n" else by for c in match[0])

    return token.sub(hidden, text)


def closing(text, at, opening, ending):
    """Where the bracket that opens at `at` closes; none before a statement's end: None."""
    depth = 0
    for k in range(at, len(text)):
        if text[k] == opening:
            depth += 1
        elif text[k] == ending:
            depth -= 1
            if depth == 0:
                return k
        elif text[k] in ";{" and opening == "<":
            return None
    return None


def mutable_text(text):
    """The text, in places of its own, without what is no arithmetic and no decision."""
    text = without_comments_and_strings(text)
    for pattern in (r"^[ ]*#(?:[^\n]*\\\n)*[^\n]*",  # preprocessor
                    r"\bthrow\b[^;]*;", r"\bstatic_assert\b[^;]*;", r"\bassert\([^;]*;",
                    r"^[^\n]*\breserve\([^\n]*", r"^ *\w+ \w+(?:\[\w+\])+ = \{\};", r"\boperator\S+\(", r"\) (?:const )?= 0;"):
        for match in list(re.finditer(pattern, text, re.MULTILINE)):
            text = hide(text, match.start(), match.end())
    for match in re.finditer(r"\w<(?![<=])", text):
        end = closing(text, match.end() - 1, "<", ">")
        if end is not None:
            text = hide(text, match.end() - 1, end + 1)
    return text


def changed_number(digits):
    """Another number, or None where it only bounds rounding, or what a machine can hold."""
    plain = digits.replace("'", "")
    whole = not re.search(r"[.eE]", plain)
    if whole and plain.startswith("0") and plain != "0":
        return None
    value = float(plain)
    if value == 0.0:
        return "1" if whole else "1.0"
    if not 1e-6 < value < 1e6:
        return None
    if whole:
        return str(int(plain) + 1)
    changed = f"{0.82 * value:.6g}"
    return changed if re.search(r"[.e]", changed) else changed + ".0"


def branches(text, mutable):
    for match in BRANCH.finditer(mutable):
        begin = match.end()
        end = closing(mutable, begin - 1, "(", ")")
        if end is None:
            continue
        inside = mutable[begin:end]
        if ";" in inside or " = " in inside or "\n" in inside:
            continue
        condition = text[begin:end]
        guard = GUARD.match(mutable, end + 1)
        never = "guard dropped" if guard else "condition never"
        yield Mutation(never, begin, end, f"({condition}) && false")
        if match[1] == "if":
            yield Mutation("condition always", begin, end, f"({condition}) || true")
            yield Mutation("condition negated", begin, end, f"!({condition})")


def mutations(text):
    """All of a source's."""
    mutable = mutable_text(text)
    for match in OPERATOR.finditer(mutable):
        if HIDDEN in mutable[match.start() - 2] + mutable[match.end() + 1:match.end() + 2]:
            continue  # beside a string
        for new in SWAPS[match[1]]:
            yield Mutation("operator", match.start(1), match.end(1), new)
    for match in SIGN.finditer(mutable):
        yield Mutation("sign", match.start(), match.end(), "")
    for match in COUNT_UP.finditer(mutable):
        yield Mutation("operator", match.start(), match.end(), "--")
    for match in NUMBER.finditer(mutable):
        new = changed_number(match[1])
        if new is not None:
            yield Mutation("constant", match.start(1), match.end(1), new)
    for match in TRUTH.finditer(mutable):
        yield Mutation("constant", match.start(), match.end(),
                       "false" if match[1] == "true" else "true")
    yield from branches(text, mutable)


def by_line(text):
    """{line, from 1: its mutations}"""
    lines = {}
    for one in mutations(text):
        lines.setdefault(text.count("\n", 0, one.begin) + 1, []).append(one)
    return lines


def mutated(text, mutation):
    return text[:mutation.begin] + mutation.new + text[mutation.end:]
