"""The files of a work-precision chart, and its picture, which is drawn from them."""

from __future__ import annotations

import csv
import json
import math
import os
import subprocess
import sys
from typing import Any

from numpy.typing import NDArray

_drawing = os.path.join(os.path.dirname(__file__), "drawing")


def save(
    folder: str | os.PathLike[str],
    tables: dict[str, NDArray[Any]],
    record: dict[str, Any],
    scene: str,
    reference: dict[str, Any],
) -> None:
    """Writes each table as a CSV file of its name, the record as chart.json, and reference.json."""
    os.makedirs(folder, exist_ok=True)
    for name, rows in tables.items():
        with open(os.path.join(folder, f"{name}.csv"), "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(rows.dtype.names or ())
            writer.writerows([_cell(value) for value in row.tolist()] for row in rows)
    with open(os.path.join(folder, "chart.json"), "w", encoding="utf-8") as file:
        json.dump(record, file)
    with open(os.path.join(folder, "reference.json"), "w", encoding="utf-8") as file:
        json.dump(_reference(scene, reference), file, indent=1)


def draw(folder: str, path: str | os.PathLike[str]) -> None:
    """Draws the chart whose files are in the folder into a PNG or SVG file."""
    ending = os.path.splitext(os.fspath(path))[1].lower()
    if ending not in (".png", ".svg"):
        raise ValueError(f"{os.fspath(path)}: allowed are the endings .png and .svg")
    done = subprocess.run(
        [sys.executable, os.path.join(_drawing, "work_precision.py"), folder],
        env={**os.environ, "PYTHONPATH": _drawing, "MPLBACKEND": "Agg"},
        capture_output=True,
        text=True,
    )
    if done.returncode != 0:
        raise RuntimeError(f"the chart cannot be drawn: {done.stderr.strip()[-300:]}")
    with open(os.path.join(folder, f"chart{ending}"), "rb") as drawn, open(path, "wb") as file:
        file.write(drawn.read())


def _reference(scene: str, record: dict[str, Any]) -> dict[str, Any]:
    certified = record["certified"]
    copied = (
        "until made_by chaotic rounding_effect beyond_horizon lyapunov modal_shares_floor "
        "only_symmetric"
    ).split()
    return {
        "scene": scene,
        **{name: record[name] for name in copied},
        **{f"certified_{name}": certified[name] for name in ("position", "velocity", "energy")},
        "horizon": _finite(record["horizon"]),
        "out_of_symmetry": {"horizon": _finite(record.get("symmetric_until", math.inf))},
        "scales": {"displacement": record["displacement"], "parts": record["parts"]},
    }


def _cell(value: Any) -> Any:
    if isinstance(value, float):
        return repr(value) if math.isfinite(value) else ""
    return value


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
