"""What was found on one scene, as the row of a table: the fastest method at each accuracy."""

import json
import math
from dataclasses import dataclass, field

from measurements import BadInput
from method_kinds import kind_of
from style import seconds

DECADES = tuple(10.0**-digit for digit in range(1, 10))


@dataclass(frozen=True)
class Row:
    """A scene: its title, nodes, springs, end [s], and the least number of Verlet's steps to it
    (None where that is not known). By accuracy: the fastest point, how many times as long the best
    of SUNDIALS takes, and the next method where it is known. For the study: kinds and number
    of methods, the processor, the accuracies asked for, and whether they are those of the energy."""

    title: str
    nodes: int
    springs: int
    until: float
    steps: float | None
    processor: str
    front: dict
    ratios: dict
    kinds: dict
    methods: int
    accuracies: tuple = DECADES
    margins: dict = field(default_factory=dict)
    is_by_energy: bool = False

    @property
    def size(self):
        """How many nodes and springs, in words."""
        return f"{counted(self.nodes, 'node')}, {counted(self.springs, 'spring')}"

    @property
    def duration(self):
        """The end and the steps to it, in words."""
        if not self.steps:
            return seconds(self.until)
        steps = round(self.steps, 1 - math.floor(math.log10(self.steps)))
        return f"{seconds(self.until)}, {steps:,.0f} steps"

    @property
    def front_kinds(self):
        """The kinds of the methods that are the fastest anywhere."""
        return {self.kinds[point.method] for point in self.front.values()}

    def stretches(self, accuracies):
        """The neighbouring ones of these accuracies with one fastest method: (method, first, last
        place)."""
        found = []
        for place, accuracy in enumerate(accuracies):
            if accuracy not in self.front:
                continue
            method = self.front[accuracy].method
            if found and found[-1][0] == method and found[-1][2] == place - 1:
                found[-1] = (method, found[-1][1], place)
            else:
                found.append((method, place, place))
        return found


def accuracy_key(accuracy):
    """An accuracy, to the digits that tell two accuracies apart."""
    return float(f"{accuracy:.3g}")


def by_accuracy(front):
    """The points of a front by their accuracies."""
    return {accuracy_key(point.accuracy): point for point in front}


def counted(number, noun):
    """So many of something, in words."""
    return f"{number} {noun}" + ("" if number == 1 else "s")


def read_sidecar(path):
    """What the sidecar of points.csv says: the scene's name, and size, end, steps and processor as
    a row has them."""
    try:
        with open(path, encoding="utf-8") as file:
            about = json.load(file)
        scene, until = about["scene"], float(about["until"])
        step = about["reduced"]["largest_stable_step"]
        return scene["name"], {
            "nodes": scene["nodes"],
            "springs": scene["springs"],
            "until": until,
            "steps": until / step if step else None,
            "processor": about["cpu"],
        }
    except (OSError, LookupError, ValueError, TypeError, AttributeError) as error:
        raise BadInput(f"{path} cannot be read: {error}.") from error


def of_record(record, front):
    """What a row says of methods: the record.Record of one scene, and a front by accuracy."""
    runs = record.judged.runs
    best = {
        accuracy_key(row["accuracy"]): runs[row["sundials"]]
        for row in record.rows
        if row["sundials"] is not None
    }
    return {
        "front": front,
        "ratios": {key: best[key].time / point.time for key, point in front.items() if key in best},
        "kinds": {run.method: kind_of(run) for run in runs if not run.failure},
        "methods": len({run.method for run in runs}),
    }
