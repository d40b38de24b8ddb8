# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# Which files are pages of the site, and what their links become there.
import json
import os
import re
import shutil
import tomllib
import zipfile
from pathlib import Path

import notebook_cells

HERE = Path(__file__).resolve().parent
TOP = HERE.parents[1]
LINK = re.compile(r'(\]\(|<img src=")([^)"\s]+)')

IMAGE = re.compile(r'^<img src="([^"]+)" width="(\d+)" alt="([^"]*)">$', re.M)


def as_directive(image):
    """An <img> as Sphinx takes it, with a colon in its text or not."""
    return (f"```{{image}} {image[1]}\n---\nalt: {json.dumps(image[3])}\nwidth: {image[2]}px\n---\n```")


class Contents:
    """The parts of the site, and of every page that is written by hand its file."""

    def __init__(self):
        read = tomllib.loads((HERE / "contents.toml").read_text())
        elsewhere = read["elsewhere"]
        self.parts = []  # (caption, [docname])
        self.files = {"index": elsewhere["index"]}  # docname: path below the top
        for part in read["part"]:
            names = []
            for entry in part["pages"]:
                name = entry.removeprefix("made:").removeprefix("?")
                if not entry.startswith("made:"):
                    path = elsewhere.get(name, f"docs/{name}.md")
                    if entry.startswith("?") and not (TOP / path).exists():
                        continue
                    self.files[name] = path
                names.append(name)
            self.parts.append((part["caption"], names))
        # Pages of a folder: how-to/robots leads to how-to/robots/*.md.
        for name in list(self.files):
            folder = TOP / self.files[name].removesuffix(".md")
            for path in sorted(folder.glob("*.md")) if name != "index" else []:
                self.files[f"{name}/{path.stem}"] = str(path.relative_to(TOP))
        self.names = {path: name for name, path in self.files.items()}

    def below(self, name):
        return [one for one in self.files if one.startswith(name + "/")]


def slug_of(name):
    """An effect's page."""
    return re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-")


def without_code(text):
    """The text's lines, each with whether it stands outside of code blocks."""
    fence = None
    for line in text.splitlines(keepends=True):
        mark = re.match(r"\s*(```+|~~~+)", line)
        if fence is None and mark:
            fence = mark[1]
            yield line, False
        elif fence is not None:
            if mark and mark[1].startswith(fence):
                fence = None
            yield line, False
        else:
            yield line, True


class Stage:
    """A folder of pages as Sphinx reads them: copies, made at every build, with links that fit."""

    def __init__(self, folder, contents, notebooks):
        self.folder = folder
        self.contents = contents
        self.notebooks = notebooks  # where the executed ones are, if they are
        self.made = set()

    def forget(self):
        """Takes away what an earlier build has left."""
        for path in sorted(self.folder.rglob("*"), reverse=True):
            if path.is_file() and path not in self.made:
                path.unlink()
            elif path.is_dir() and not any(path.iterdir()):
                path.rmdir()

    def copy(self, source, name):
        """What has not changed keeps its time, so that Sphinx does not do it again."""
        target = self.folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        self.made.add(target)
        if not target.exists() or target.read_bytes() != source.read_bytes():
            shutil.copyfile(source, target)

    def write(self, name, text, ending=".md"):
        path = self.folder / (name + ending)
        path.parent.mkdir(parents=True, exist_ok=True)
        self.made.add(path)
        if not path.exists() or path.read_text() != text:
            path.write_text(text)

    def file(self, path):
        """A file of the project, or a folder as an archive, to be downloaded; its place here."""
        source = TOP / path
        target = self.folder / "files" / path
        if source.is_dir():
            target = target.with_name(target.name + ".zip")
            self.made.add(target)
            target.parent.mkdir(parents=True, exist_ok=True)
            with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as archive:
                for one in sorted(source.rglob("*")):
                    if one.is_file():
                        archive.writestr(zipfile.ZipInfo(f"{source.name}/{one.relative_to(source)}"),
                                         one.read_bytes(), zipfile.ZIP_DEFLATED)
        else:
            self.copy(source, target.relative_to(self.folder))
        return target.relative_to(self.folder)

    def link(self, target, path, name):
        """What a link of the page at `path` becomes on the site's page `name`."""
        if re.match(r"[a-z]+:", target):
            return target
        file, _, anchor = target.partition("#")
        anchor = "#" + anchor if anchor else ""
        if not file:
            return target
        at = os.path.normpath(os.path.join(os.path.dirname(path), file))
        back = os.path.dirname(name)
        if at.endswith("README.md") and at not in self.contents.names:
            at = os.path.dirname(at)
        header = re.fullmatch(r"include/trussmap/([a-z_]+)\.hpp", at)
        if header and header[1] != "trussmap":
            return os.path.relpath(f"cpp/{header[1]}.rst", back or ".")
        if at == "include/trussmap":
            return os.path.relpath("cpp/index.md", back or ".")
        if at == "docs/effects.md" and anchor == "#catalogue" and name != "effects":
            return os.path.relpath("gallery/index.md", back or ".")  # the catalogue's pages
        if at in self.contents.names:
            return os.path.relpath(self.contents.names[at] + ".md", back or ".") + anchor
        if at in ("docs", "docs/"):
            return os.path.relpath("index.md", back or ".")
        return os.path.relpath(self.file(at), back or ".")

    def page(self, name, path):
        text = ""
        for line, prose in without_code((TOP / path).read_text()):
            if prose:
                line = LINK.sub(lambda m: m[1] + self.link(m[2], path, name), line)
                line = IMAGE.sub(as_directive, line)
            text += line
        if name == "effects":  # the catalogue's rows lead to the gallery
            text = re.sub(r"^\| (`([a-z][a-z0-9 -]+)(?: \([^`]*\))?`) \|(?=[^|]*\| `[a-z_0-9]+` ×)",
                          lambda m: f"| [{m[1]}](gallery/{slug_of(m[2])}.md) |", text, flags=re.M)
        if path.startswith("docs/notebooks/"):
            text = self.notebook(name, text)
        below = self.contents.below(name)
        if below:
            text += tree([os.path.relpath(one, os.path.dirname(name)) for one in below])
        if name == "index":
            for caption, names in self.contents.parts:
                text += tree(names, caption)
        self.write(name, text)

    def notebook(self, name, text):
        """The page with what it printed and drew when it was executed, as it is now."""
        pictures = []

        def keep(picture):
            path = self.folder / f"{name}-{len(pictures) + 1}.png"
            pictures.append(path)
            self.made.add(path)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(picture)
            return path.name

        cells = notebook_cells.executed_cells(self.notebooks / f"{Path(name).name}.ipynb")
        return notebook_cells.shown(text, cells, keep) or text + (
            "\n\n*Not executed when this site was built: `make notebooks` before it shows what the cells print and "
            "draw.*\n")


def tree(names, caption=None):
    head = f":caption: {caption}\n" if caption else ""
    return "\n\n```{toctree}\n:hidden:\n" + head + "\n" + "\n".join(names) + "\n```\n"
