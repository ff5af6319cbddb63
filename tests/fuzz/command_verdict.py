"""Faults in how a program took a command line: kinds of them, each with its detail."""

import os
import re

from written_tables import faults

DOCUMENTED = {0, 2, 3, 130}
_CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f]")


def _value_of(argv, name):
    values = [argv[k + 1] for k, a in enumerate(argv[:-1]) if a == name]
    values += [a[len(name) + 1 :] for a in argv if a.startswith(name + "=")]
    try:
        return float(values[-1]) if values else None
    except ValueError:
        return None


def _of_time(argv, run):
    if run.status is None:
        yield "hangs: SIGINT does not end it", f"after {run.seconds_to_end:.1f} s"
        return
    limit = _value_of(argv, "--time-limit")
    if run.asked_to_end:
        if run.status != 130 and not (limit is not None and run.status == 3):  # which came first
            yield f"SIGINT: status {run.status} where 130 is documented", ""
        if limit is not None and 0 < limit <= 1 and run.cpu > limit + 1:
            yield "--time-limit is not kept", f"{limit} s, {run.cpu:.1f} s of processor time"


def _of_status(program, run, err):
    if run.status is None or run.asked_to_end:
        return
    if run.status < 0:
        yield f"ends by signal {-run.status}", err[-200:]
    elif run.status not in DOCUMENTED:
        yield f"undocumented status {run.status}", err[-200:]
    elif run.status == 130:
        yield "status 130 without a signal", err[-200:]
    elif run.status in (2, 3):
        lines, warning = err.split("\n"), f"{program}: warning: "
        said = [line for line in lines[:-1] if not line.startswith(warning)]
        if lines[-1] or run.status == 2 and len(said) != 1:
            kind = f"status {run.status}: {len(said)} lines where one sentence is documented"
            yield kind, err[-300:]
        elif not said or not re.match(rf"{program}: .{{10}}", said[-1]):
            yield f"status {run.status} without a sentence of the program's", err[-300:]


def _is_output_alone(name, argv, sandbox):
    """Whether that is a scene which the command line names once: as what it writes."""
    here = os.path.join(sandbox.root, "here")
    own = os.path.realpath(os.path.join(here, name))
    named = [os.path.realpath(os.path.join(here, a.split("=", 1)[-1])) for a in argv]
    return name.endswith(".toml") and named.count(own) == 1


def _of_scarcity(run, err, scarce):
    last = err.rstrip("\n").rpartition("\n")[2]
    if scarce == "memory" and run.status in (2, 3):
        if "memory" not in last or not re.search(r"\d|results/", last):
            yield "no sentence on how much memory, or for which file", last[:200]
    if scarce == "disk" and run.status in (2, 3) and "results" not in last:
        yield "no sentence that names the file without room", last[:200]


def _of_files(argv, run, sandbox, scarce):
    files, folders, changed = sandbox.changes()
    forced = "--force" in argv
    for name in changed:
        inside = os.path.relpath(name, "here")
        if not name.startswith("here/"):
            yield "something outside the folder changed", name
        elif inside in sandbox.inputs or inside in ("link.toml", "$x.toml"):
            if not (forced and _is_output_alone(inside, argv, sandbox)):
                yield "an input was changed", inside
        elif inside in ("dangling", "loop"):
            continue  # links to nowhere, which hold nothing
        elif not inside.startswith("results/") and not forced:
            yield "a user's own file was changed", inside
    for name in files + folders:
        if name.startswith("home"):  # beside "here" is where "--out .." points to
            yield "something outside the folder was written", name
    if run.status == 2 and files and not scarce:
        yield "status 2, and files are left", ", ".join(sorted(files))[:200]
    if run.status in (0, 2, 3, 130):
        written = [n for n in files + changed if "/mine/" not in n or n in files]
        for fault in faults(sandbox.root, [n for n in written if n.startswith("here/")]):
            if "--write-scene" not in argv:  # whose TOML may be called .csv
                yield "a file is not whole", fault


def verdict(program, argv, run, sandbox, scarce=""):
    """Pairs of a fault's kind and its detail; none if the run was as documented. `scarce`: "disk" or
    "memory" for a run with little of it."""
    err, out = (text.decode(errors="backslashreplace") for text in (run.err, run.out))
    found = [*_of_time(argv, run), *_of_status(program, run, err)]
    found += [*_of_files(argv, run, sandbox, scarce), *_of_scarcity(run, err, scarce)]
    for name, text in [("stdout", out), ("stderr", err)]:
        control = _CONTROL.search(text)
        if control:
            found.append((f"a control character reaches {name}", repr(control.group())))
    if "terminate called" in err or "AddressSanitizer" in err or "runtime error" in err:
        found.append(("an abort or a sanitizer's report", err[:300]))
    return found


def signature(program, kind, detail):
    """The same for findings that are likely the same fault."""
    words = re.sub(r"\S*[/.\\]\S*|'[^']*'|\"[^\"]*\"|--[\w-]+ \S*", "_", detail)
    return program, kind, re.sub(r"[-+]?\d[\d.e+-]*", "#", words)[:80]
