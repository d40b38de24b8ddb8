# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# A notebook is a page of Markdown: each block `python` is a cell, what stands between them is text
# (the Markdown format of jupytext). Which cells a page has, and what an executed notebook says below
# each. Needs nothing of Jupyter.
import base64
import json
import re

CELL = re.compile(r"^```python\n(.*?)^```$", re.M | re.S)


def parts_of(page):
    """("text" or "code", what) in the page's order."""
    parts, end = [], 0
    for block in CELL.finditer(page):
        parts += [("text", page[end:block.start()].strip()), ("code", block[1].strip())]
        end = block.end()
    parts.append(("text", page[end:].strip()))
    return [(kind, text) for kind, text in parts if text]


def executed_cells(file):
    """Source and outputs of the code cells of an executed notebook; [] where there is none."""
    if not file.exists():
        return []
    cells = json.loads(file.read_text(encoding="utf-8"))["cells"]
    return [("".join(cell["source"]), cell["outputs"]) for cell in cells
            if cell["cell_type"] == "code"]


def fenced(text):
    """A block of text that has itself no fence of that length."""
    fence = "`" * max(3, 1 + max((len(run) for run in re.findall("`+", text)), default=0))
    return f"{fence}{{code-block}} text\n:class: cell-output\n\n{text.rstrip()}\n{fence}\n"


def output_of(output, keep):
    """An output as Markdown; keep(bytes) stores a picture and gives its place."""
    if output["output_type"] == "stream":
        return fenced("".join(output["text"])) if output["name"] == "stdout" else ""
    data = output.get("data", {})
    if "image/png" in data:
        return f"![]({keep(base64.b64decode(data['image/png']))})\n"
    if "text/html" in data:
        lines = [line for line in "".join(data["text/html"]).splitlines() if line.strip()]
        return "```{raw} html\n" + "\n".join(lines) + "\n```\n"
    return fenced("".join(data["text/plain"])) if "text/plain" in data else ""


def shown(page, cells, keep):
    """The page with the outputs below its cells; None where the executed cells are not its own."""
    parts = parts_of(page)
    if [text for kind, text in parts if kind == "code"] != [source for source, _ in cells]:
        return None
    outputs = iter(cells)
    lines = []
    for kind, text in parts:
        if kind == "text":
            lines.append(text)
            continue
        lines.append(f"```python\n{text}\n```")
        lines += [output_of(one, keep) for one in next(outputs)[1]]
    return "\n\n".join(one for one in lines if one) + "\n"
