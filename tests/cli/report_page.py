#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The page of frontmost report in use: clicks, sorting and widths, in a headless browser.

    report_page.py PROGRAM

A script is added to a copy of the page. The script clicks and writes what the page then shows into the page, which the
browser prints. Skipped if there is neither chromium-headless-shell nor chromium.
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

# A picture of 10 x 10 pixels, one unit a pixel at depth 10: 6 x 6 pixels from (2, 2); 4 x 4 before them from (7, 1),
# with one column beyond the frame; and one far outside.
SQUARES = [("far", -3, -3, 6, 10), ("near", 2, 0, 4, 9), ("away", 40, 0, 2, 10)]
VIEW = ("--camera-position 0,0,10 --camera-focal-point 0,0,0 --camera-view-up +y --intrinsics 100,100,5,5 "
        "--pixel-center half --resolution 10,10 --near 1 --far 200").split()

TOOLS = """
const all = selector => [...document.querySelectorAll(selector)];
const names = () => all('tbody th').map(cell => cell.textContent);
const title = () => panel.querySelector('h2') ? panel.querySelector('h2').textContent : '';
const pixel = (x, y) => [...context.getImageData(x, y, 1, 1).data];
const clickPixel = (x, y) => {
  const place = canvas.getBoundingClientRect();
  canvas.dispatchEvent(new MouseEvent('click', {bubbles: true,
    clientX: place.left + (x + 0.5) / data.width * place.width,
    clientY: place.top + (y + 0.5) / data.height * place.height}));
};
const head = name => all('thead button').find(button => button.textContent === name);
"""

CLICKS = TOOLS + """
told.start = [names(), title()];
outlines.click();
clickPixel(3, 3);
told.far = [title(), all('tr.chosen').map(row => row.dataset.object), all('.graph .chosen').length,
            panel.textContent.includes('33') && panel.textContent.includes('91.7 %'),
            all('#panel li').map(item => item.textContent)];
told.mask = [pixel(3, 3), pixel(7, 2)[3], pixel(0, 0), rgb(1).map(Math.round), pixel(7, 2)];
outlines.click();
told.outlined = pixel(1, 4);
all('#panel li button')[0].click();
told.hider = title();
clickPixel(8, 2);
told.again = title();
clickPixel(8, 2);
clickPixel(0, 0);
told.nothing = title();
all('tbody tr')[2].click();
told.row = title();
all('g.node').find(node => node.dataset.object === '1').dispatchEvent(new MouseEvent('click', {bubbles: true}));
told.node = title();
told.sorted = {};
for (const column of ['name', 'object', 'hidden share', 'distance']) {
  head(column).click();
  const first = names(), sort = head(column).parentNode.getAttribute('aria-sort');
  head(column).click();
  told.sorted[column] = [sort, first, head(column).parentNode.getAttribute('aria-sort'), names()];
}
told.marks = all('thead th[aria-sort]').length;
"""

WIDTHS = TOOLS + """
const table = document.querySelector('.scroll.table');
told.page = [document.documentElement.scrollWidth, innerWidth];
told.table = [table.scrollWidth, table.clientWidth];
all('tbody tr')[0].click();
told.chosen = [document.documentElement.scrollWidth, innerWidth];
head('name').click();
"""

NOTE = """
const note = document.createElement('pre');
note.id = 'told';
note.textContent = JSON.stringify(told);
document.body.append(note);
"""


def square(name, x, y, side, depth):
    scale, z = depth / 100, 10 - depth
    corners = [(x, y), (x + side, y), (x + side, y + side), (x, y + side)]
    return f"o {name}\n" + "".join(f"v {a * scale} {b * scale} {z}\n" for a, b in corners) + "f -4 -3 -2 -1\n"


def look(browser, page, script, width):
    text = page.read_text()
    copy = page.with_suffix(".clicked.html")
    copy.write_text(text.replace("</body>", "<script>const told = {}; try {" + script + "} catch (error) { told.error = String(error); }" +
                                 NOTE + "</script></body>"))
    done = subprocess.run([browser, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={page.parent}/user",
                           f"--window-size={width},900", "--dump-dom", copy.as_uri()], capture_output=True, timeout=900)
    found = re.search(r'<pre id="told">(.*?)</pre>', done.stdout.decode())
    if not found:
        sys.exit(f"{browser} says nothing: {done.stderr.decode()[-500:]}")
    told = json.loads(found.group(1).replace("&amp;", "&").replace("&lt;", "<").replace("&gt;", ">"))
    if "error" in told:
        sys.exit(f"the page says {told['error']}")
    return told


def check(what, found, expected):
    if found != expected:
        sys.exit(f"{what}: {found} is not {expected}")


def check_clicks(told):
    check("the page at first", told["start"], [["far", "near", "away"], ""])
    check("far, clicked in the picture", told["far"], ["far", ["0"], 2, True, ["near3 · 8.3 %"]])
    seen, hidden_alpha, outside, hider, hidden = told["mask"]
    check("the mask where far is seen", [seen[3], abs(seen[0] - 255) < 4, abs(seen[1] - 140) < 4], [110, True, True])
    check("the mask where it is hidden", hidden_alpha, 190)
    check("its colour there", [abs(a - b) < 4 for a, b in zip(hider, hidden)], [True] * 3)
    check("the picture elsewhere", outside, [0, 0, 0, 120])
    check("an outline", told["outlined"][3], 200)
    check("what hides it, clicked in the panel", told["hider"], "near")
    check("the same, clicked in the picture", told["again"], "")
    check("a click beside everything", told["nothing"], "")
    check("a row", told["row"], "away")
    check("a node of the graph", told["node"], "near")
    up, down = "ascending", "descending"
    check("sorting", told["sorted"], {
        "name": [up, ["away", "far", "near"], down, ["near", "far", "away"]],
        "object": [down, ["away", "near", "far"], up, ["far", "near", "away"]],
        "hidden share": [down, ["far", "near", "away"], up, ["near", "away", "far"]],
        "distance": [down, ["away", "far", "near"], up, ["near", "far", "away"]],
    })
    check("columns that are marked as sorted", told["marks"], 1)


def main():
    browser = shutil.which("chromium-headless-shell") or shutil.which("chromium")
    if not browser:
        print("skipped: there is neither chromium-headless-shell nor chromium")
        sys.exit(77)
    program = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)

        def report(model, page, *options):
            subprocess.run([program, "report", model, "-o", page, "--quiet", *options], cwd=folder, check=True,
                           stdout=subprocess.DEVNULL, timeout=900)
            return folder / page

        (folder / "squares.obj").write_text("".join(square(*s) for s in SQUARES))
        check_clicks(look(browser, report("squares.obj", "squares.html", *VIEW), CLICKS, 1200))
        gallery = report("builtin:gallery", "gallery.html", "--resolution", "320,240")
        told = look(browser, gallery, WIDTHS, 1200)
        check("the width of the table", told["table"][0], told["table"][1])
        long = "a_part_of_an_assembly_whose_name_is_long"
        (folder / "long.obj").write_text("".join(square(long + s[0], *s[1:]) for s in SQUARES))
        told = look(browser, report("long.obj", "long.html", "--resolution", "4000,4000", "--view", "front"), WIDTHS, 1200)
        check("the width of a table of long names", told["table"][0], told["table"][1])
        for width in [1200, 390]:
            told = look(browser, gallery, WIDTHS, width)
            for state in ["page", "chosen"]:
                check(f"{state} fits into {width}", told[state][0] <= told[state][1], True)
        (folder / "empty.obj").write_text("v 0 0 0\n")
        look(browser, report("empty.obj", "empty.html", "--resolution", "10,10"), TOOLS + "head('name').click();", 800)


main()
