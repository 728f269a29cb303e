#!/usr/bin/python3
"""External estimator for binpick: one flat part, lying on top of the heap (docs/external_protocol.md).

It takes the highest patch of the scene, centres the part on it with its z axis towards the camera, and says so. Good for a
single ring or plate; meant to be read. Needs python3-numpy, python3-pil, python3-yaml.
"""
import math
import os
import sys

import numpy as np
import yaml
from PIL import Image

SLAB = 0.006  # m below the highest point that still belong to its patch


def rotation(rpy):
    (cr, sr), (cp, sp), (cy, sy) = [(math.cos(a), math.sin(a)) for a in map(float, rpy)]
    return (np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]]) @ np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
            @ np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]]))


def mesh_box(path):
    """Corners of a binary STL's bounding box, metres."""
    facet = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])
    corners = np.fromfile(path, dtype=facet, offset=84)["corners"].reshape(-1, 3) / 1000
    return corners.min(axis=0), corners.max(axis=0)


def main(folder):
    with open(os.path.join(folder, "request.yaml"), encoding="utf-8") as file:
        request = yaml.safe_load(file)
    camera = {key: float(value) for key, value in request["camera"].items()}
    depth = np.array(Image.open(os.path.join(folder, "depth.tiff")), dtype=float)
    v, u = np.nonzero(np.isfinite(depth))
    z = depth[v, u]
    points = np.stack([(u - camera["cx"]) / camera["fx"] * z, (v - camera["cy"]) / camera["fy"] * z, z], axis=1)
    R_CB, t_CB = rotation(request["X_CB"]["rpy"]), np.array(request["X_CB"]["xyz"], dtype=float)
    in_bin = (points - t_CB) @ R_CB
    size = np.array(request["bin"]["inner_size"], dtype=float)
    inside = (np.abs(in_bin[:, :2]) < size[:2] / 2 - 0.02).all(axis=1) & (in_bin[:, 2] > 0.008) & (in_bin[:, 2] < size[2])
    rows = []
    if inside.sum() > 50:
        heap = in_bin[inside]
        top = np.percentile(heap[:, 2], 98)
        patch = heap[heap[:, 2] > top - SLAB]
        patch = patch[np.linalg.norm(patch[:, :2] - np.median(patch[:, :2], axis=0), axis=1) < 0.1]
        low, high = mesh_box(os.path.join(folder, request["parts"][0]["part"]["mesh"]))
        middle = (patch[:, :2].min(axis=0) + patch[:, :2].max(axis=0)) / 2
        t = R_CB @ np.array([middle[0], middle[1], np.median(patch[:, 2]) - high[2]]) + t_CB
        rows.append([0, 0.5, *R_CB.flatten(), *t])
    with open(os.path.join(folder, "estimates.csv"), "w", encoding="utf-8") as file:
        file.write("part,score,r11,r12,r13,r21,r22,r23,r31,r32,r33,tx,ty,tz\n")
        for row in rows:
            file.write(",".join(repr(float(value)) for value in row) + "\n")


if __name__ == "__main__":
    main(sys.argv[-1])
