"""How results of a study get into docs/data: whole or not at all, and no longer than pages need."""

import csv
import json
import os
import shutil

# Left out of sidecars: states of all nodes, and the command with the folders of the machine.
UNKEPT = ("q", "v", "modal_shares", "command_line", "key")


def rounded(cell):
    """A number of a table in the six digits that pages can need; anything else as it is."""
    try:
        return f"{float(cell):.6g}"
    except ValueError:
        return cell


def keep(file, folder, name=None, columns=None):
    """Copies a result, whole or not at all; a table with these columns, or all, in six digits."""
    folder.mkdir(parents=True, exist_ok=True)
    target = folder / (name or file.name)
    part = target.with_name(target.name + ".part")
    if file.suffix == ".csv":
        with open(file, newline="", encoding="utf-8") as source:
            rows = list(csv.DictReader(source))
        with open(part, "w", encoding="utf-8") as copy:
            names = columns or list(rows[0])
            writer = csv.writer(copy, lineterminator="\n")
            writer.writerow(names)
            writer.writerows([rounded(row[name]) for name in names] for row in rows)
    elif file.suffix == ".json":
        facts = json.loads(file.read_text(encoding="utf-8"))
        kept = {key: value for key, value in facts.items() if key not in UNKEPT}
        part.write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")
    else:
        shutil.copyfile(file, part)
    os.replace(part, target)
