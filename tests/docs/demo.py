#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the demo's page, and checks it as a browser would read it.

    demo.py DEMO PROGRAM FOLDER

Every command of the page has run, its pictures are embedded in the page and its files lie beside it. Command lines
break only between words, so that no option is split at its hyphens.
"""
import html.parser
import pathlib
import subprocess
import sys


class Page(html.parser.HTMLParser):
    """Parts of a page that the tests check: images, links, and the words of commands."""

    def __init__(self, text):
        super().__init__()
        self.images, self.links, self.commands, self.outside = [], [], [], []
        self.open = []
        self.feed(text)
        assert not self.open, f"never closed: {self.open}"

    def handle_starttag(self, tag, attributes):
        found = dict(attributes)
        if tag == "img":
            self.images.append(found)
        if tag == "a":
            self.links.append(found["href"])
        self.outside += [v for k, v in attributes if k in ("src", "href") and "//" in v.split(",")[0]]
        if tag not in ("img", "meta"):
            self.open.append((tag, found.get("class")))
        if tag == "pre":
            self.commands.append([])

    def handle_endtag(self, tag):
        opened, _ = self.open.pop()
        assert opened == tag, f"<{opened}> ends with </{tag}>"

    def handle_data(self, data):
        if ("pre", None) not in self.open or not data.strip():
            return
        assert self.open[-1] == ("span", "word") and " " not in data, f"may be broken: {data}"
        self.commands[-1].append(data)


def main():
    demo, program, folder = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
    folder.mkdir(parents=True, exist_ok=True)
    subprocess.run([sys.executable, demo, program, folder], check=True, stdout=subprocess.DEVNULL)
    page = Page((folder / "index.html").read_text())
    assert not page.outside, f"the page needs {page.outside}"
    assert all(i["src"].startswith("data:image/") and i["alt"] for i in page.images)
    assert all((folder / link).is_file() for link in page.links)
    files = [name for words in page.commands for option, name in zip(words, words[1:]) if option == "-o"]
    assert files and all((folder / name).is_file() for name in files)
    # The drawings include a sheet, a plotter's drawing and a figure for a paper.
    drawn = [" ".join(c) for c in page.commands if c[1] == "lines"]
    for sign in ("--views", "--plot", "--style figure"):
        assert any(sign in command for command in drawn), sign
    assert {".svg", ".pdf", ".dxf"} <= {pathlib.Path(link).suffix for link in page.links}
    assert len(page.images) + 3 == len(page.commands), "three commands write numbers, all others a picture"
    print(f"{len(page.commands)} commands, {len(page.images)} pictures, {len(page.links)} links")


main()
