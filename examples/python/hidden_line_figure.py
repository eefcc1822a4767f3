# SPDX-License-Identifier: Apache-2.0
"""Hidden lines as a matplotlib figure, with its fonts and formats. hidden_line_figure.py MODEL"""
import sys

import matplotlib
import matplotlib.pyplot as plt
from matplotlib.collections import LineCollection

import frontmost as fm

matplotlib.use("Agg")
surfaces = fm.Surfaces(fm.load(sys.argv[1]))
view = fm.frame(surfaces, 1600, 1200, direction="iso", orthographic=True)
drawing = surfaces.draw_lines(view, outlines=True)
classes = ((~drawing.is_seen, 0.6, "#8aa0b8", (0, (4, 3)), "hidden"),
           (drawing.is_seen & ~drawing.is_outline, 0.9, "#203040", "-", "seen"),
           (drawing.is_seen & drawing.is_outline, 1.8, "black", "-", "outline"))
figure, axes = plt.subplots(figsize=(6.4, 4.4))
for which, width, color, style, label in classes:
    axes.add_collection(LineCollection(drawing.segments[which], linewidths=width, colors=color, linestyles=style,
                                       label=label, capstyle="round"))
axes.set(xlim=(0, view.width), ylim=(view.height, 0), aspect="equal")  # pixels: y down
axes.axis("off")
axes.legend(loc="upper right", frameon=False)
figure.tight_layout()
figure.savefig("hidden_line_figure.png", dpi=100)
figure.savefig("hidden_line_figure.pdf")
