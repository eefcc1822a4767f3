#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes a small part to draw, as OBJ in millimetres, z up: an angle bracket of 60 x 40 x 50 with a hole in each leg.

    bracket.py > bracket.obj
"""
import math

LENGTH, WIDTH, HEIGHT, THICKNESS = 60, 40, 50, 8
SIDES = 96  # of the polygon that stands for a hole; drawings recognise its arcs
vertices, faces = [], []


def vertex(*place):
    vertices.append("v {:.9g} {:.9g} {:.9g}".format(*place))
    return len(vertices)


def face(*places):
    faces.append([vertex(*place) for place in places])


def circle(radius, centre):
    return [(centre[0] + radius * math.cos(2 * math.pi * i / SIDES),
             centre[1] + radius * math.sin(2 * math.pi * i / SIDES)) for i in range(SIDES)]


def plate(low, high, hole, place, turned):
    """A rectangle with a hole: each corner has a fan to the quarter of the hole that faces it. The rectangle's sides
    have no vertices, so that neighbours share whole edges."""
    corners = [(high[0], high[1]), (low[0], high[1]), (low[0], low[1]), (high[0], low[1])]
    quarter = SIDES // 4
    for q, corner in enumerate(corners):
        for i in range(q * quarter, (q + 1) * quarter):
            triangle = [corner, hole[i + 1 if i + 1 < SIDES else 0], hole[i]]
            face(*(place(*p) for p in (reversed(triangle) if turned else triangle)))
        triangle = [corner, corners[(q + 1) % 4], hole[(q + 1) * quarter % SIDES]]
        face(*(place(*p) for p in (reversed(triangle) if turned else triangle)))


def wall(hole, near, far):
    for a, b in zip(hole, hole[1:] + hole[:1]):
        face(near(*a), near(*b), far(*b), far(*a))


def main():
    floor, leg = circle(8, (38, WIDTH / 2)), circle(6, (WIDTH / 2, 32))
    flat = [lambda x, y: (x, y, 0), lambda x, y: (x, y, THICKNESS)]
    upright = [lambda y, z: (0, y, z), lambda y, z: (THICKNESS, y, z)]
    plate((0, 0), (LENGTH, WIDTH), floor, flat[0], True)
    plate((THICKNESS, 0), (LENGTH, WIDTH), floor, flat[1], False)
    wall(floor, flat[1], flat[0])
    plate((0, 0), (WIDTH, HEIGHT), leg, upright[0], True)
    plate((0, THICKNESS), (WIDTH, HEIGHT), leg, upright[1], False)
    wall(leg, upright[1], upright[0])
    profile = [(0, 0), (LENGTH, 0), (LENGTH, THICKNESS), (THICKNESS, THICKNESS), (THICKNESS, HEIGHT), (0, HEIGHT)]
    for a, b in ((1, 2), (4, 5)):  # the ends of the legs
        face((profile[a][0], 0, profile[a][1]), (profile[a][0], WIDTH, profile[a][1]),
             (profile[b][0], WIDTH, profile[b][1]), (profile[b][0], 0, profile[b][1]))
    for y, order in ((0, 1), (WIDTH, -1)):
        face(*[(x, y, z) for x, z in (profile[0], profile[1], profile[2], profile[3])][::order])
        face(*[(x, y, z) for x, z in (profile[0], profile[3], profile[4], profile[5])][::order])
    print("o bracket", *vertices, *("f " + " ".join(map(str, f)) for f in faces), sep="\n")


main()
