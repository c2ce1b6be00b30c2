#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Checks the links of a site: pages, anchors, pictures, scripts and styles.

usage: check_links.py DIRECTORY

Each must lead to a file of the site, and nothing that a page loads may come from
a network. Links to other sites, which a reader may follow, are counted only.
Exits with 1 and a line for each fault.
"""

import html.parser
import pathlib
import sys
import urllib.parse

LOADED = {("img", "src"), ("script", "src"), ("link", "href"), ("source", "srcset"), ("iframe", "src")}


class Page(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.anchors = set()
        self.links = []   # (target, whether the page loads it)
        self.faults = []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.anchors.update(filter(None, (values.get("id"), values.get("name") if tag == "a" else None)))
        if tag == "img" and not (values.get("alt") or "").strip():
            self.faults.append(f"a picture without a description: {values.get('src')}")
        for name in ("href", "src", "srcset"):
            if values.get(name):
                self.links.append((values[name], (tag, name) in LOADED))


def check(directory):
    """Returns (faults, number of links, number of links to other sites)."""
    pages = {path.resolve(): Page(path.read_text(encoding="utf-8")) for path in sorted(directory.rglob("*.html"))}
    faults, count, elsewhere = [], 0, 0
    for path, page in pages.items():
        name = path.relative_to(directory.resolve())
        faults += [f"{name}: {fault}" for fault in page.faults]
        for target, is_loaded in page.links:
            parts = urllib.parse.urlsplit(target)
            count += 1
            if parts.scheme or parts.netloc:
                elsewhere += 1
                if is_loaded and parts.scheme != "data":
                    faults.append(f"{name}: loads {target}")
                continue
            linked = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
            anchor = urllib.parse.unquote(parts.fragment)
            if linked.is_dir():
                linked = linked / "index.html"
            if not linked.is_file():
                faults.append(f"{name}: {target} leads nowhere")
            elif anchor and linked in pages and anchor not in pages[linked].anchors:
                faults.append(f"{name}: {target}: there is no such anchor")
    if not pages:
        faults.append(f"no pages in {directory}")
    return faults, count, elsewhere


def main():
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    faults, count, elsewhere = check(pathlib.Path(sys.argv[1]))
    for fault in faults:
        print(fault)
    print(f"{count} links, {elsewhere} of them to other sites, {len(faults)} faults")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
