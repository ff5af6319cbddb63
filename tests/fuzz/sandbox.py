"""A fresh folder for one run, with a scene, a user's own files and traps in it, and what a run did
to them."""

import os
import shutil
import stat
from pathlib import Path

OWN = {
    "end.json": b'{"mine": true}\n',
    "end.csv": b"my,own\n1,2\n",
    "notes.txt": b"mine\n",
    "mine/points.csv": b"my,own\n1,2\n",
    "mine/points.json": b"[1]\n",
    "mine/summary.csv": b"my,own\n3,4\n",
    "mine/reference.json": b'{"mine": 1}\n',
    "mine/map.json": b"{}\n",
    "empty.toml": b"# mine\n",
    "-dash.toml": b"dimension = 1\n",
    "locked.toml": b"dimension = 1\n",
    "body.obj": b"v 0 0 0\n",
}
LINKS = {
    "link.toml": "scene.toml", "loop": "loop", "dangling": "nowhere/file", "zero": "/dev/zero",
    "full": "/dev/full", "fifo.obj": "fifo", "folder.mesh": "folder", "locked.obj": "locked.toml",
    "zero.obj": "/dev/zero", "zero.msh": "/dev/zero", "loop.mesh": "loop",
}  # fmt: skip


class Sandbox:
    """The folder `here` of `root`, made anew from `files` (name to bytes) and the folder
    `earlier`, if any."""

    def __init__(self, root, files, earlier=None):
        self.root, self.here, self.home = root, os.path.join(root, "here"), f"{root}/home"
        for folder in ("home", "here/mine", "here/folder", "here/sub", "here/locked"):
            os.makedirs(os.path.join(root, folder))
        for name, data in (OWN | files | {"$x.toml": files.get("scene.toml", b"")}).items():
            Path(self.here, name).write_bytes(data)
        for name, target in LINKS.items():
            os.symlink(target, os.path.join(self.here, name))
        os.mkfifo(os.path.join(self.here, "fifo"))
        os.chmod(os.path.join(self.here, "locked.toml"), 0)
        os.chmod(os.path.join(self.here, "locked"), 0o500)
        if earlier:
            shutil.copytree(earlier, os.path.join(self.here, "results"))
        self.inputs = set(files)
        self.notice()

    def notice(self):
        """Takes what is there now as what was there before the run."""
        self.before = self._state()

    def _state(self):
        state = {}
        for folder, _, names in os.walk(self.root):
            state[os.path.relpath(folder, self.root)] = "folder"
            for name in names:
                path = os.path.join(folder, name)
                mode = os.lstat(path).st_mode
                if stat.S_ISREG(mode) and mode & 0o400:
                    content = Path(path).read_bytes()
                else:
                    content = os.readlink(path) if stat.S_ISLNK(mode) else stat.S_IFMT(mode)
                state[os.path.relpath(path, self.root)] = content
        return state

    def changes(self):
        """Names of new files, of new folders and of what was there before and is not as it was."""
        after = self._state()
        new = [name for name in after if name not in self.before]
        files = [name for name in new if after[name] != "folder"]
        changed = [name for name, was in self.before.items() if after.get(name) != was]
        return files, [name for name in new if after[name] == "folder"], changed

    def remove(self):
        os.chmod(os.path.join(self.here, "locked"), 0o700)
        shutil.rmtree(self.root, ignore_errors=True)
