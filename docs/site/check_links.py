#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# Every link of a built site leads somewhere: files and anchors inside of it. Links to other sites
# are not followed. Usage: check_links.py FOLDER
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.links = []
        self.anchors = {""}
        self.feed(path.read_text())

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("id", "name") and value:
                self.anchors.add(value)
            elif name in ("href", "src") and value:
                self.links.append(value)


def check(folder):
    """How many links there are; ends the program where one is dead."""
    folder = Path(folder).resolve()
    pages = {path.resolve(): Page(path) for path in folder.rglob("*.html")}
    dead, count = [], 0
    for path, page in pages.items():
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                if parts.scheme not in ("https", "http", "mailto", "data"):
                    dead.append(f"{path.relative_to(folder)}: {link}")
                continue
            count += 1
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            if target.is_dir():
                target /= "index.html"
            if not target.exists() or folder not in target.parents:
                dead.append(f"{path.relative_to(folder)}: {link}")
            elif parts.fragment and target in pages and \
                    unquote(parts.fragment) not in pages[target].anchors:
                dead.append(f"{path.relative_to(folder)}: {link}")
    if dead:
        sys.exit("dead links:\n" + "\n".join(sorted(set(dead))))
    return count


if __name__ == "__main__":
    print(f"{check(sys.argv[1])} links, none dead")
