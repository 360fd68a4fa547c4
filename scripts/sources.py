"""What the checks look at: the files of the repository, and how an offence is reported."""

import os
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
SKIPPED_FOLDERS = {".git", "build", "out", "demo_out", "node_modules", "__pycache__"}


def tracked_files():
    """Our files as sorted paths from the root: those that git knows; without git, all."""
    command = ["git", "-c", "safe.directory=*", "-C", ROOT, "ls-files", "-z"]
    try:
        listing = subprocess.run(command, capture_output=True, check=True).stdout.decode()
        names = [name for name in listing.split("\0") if name]
    except (OSError, subprocess.CalledProcessError):
        names = _walk()
    return sorted(name for name in names if not name.startswith("third_party/")
                  and os.path.isfile(os.path.join(ROOT, name)))


def _walk():
    names = []
    for folder, subfolders, files in os.walk(ROOT):
        subfolders[:] = [name for name in subfolders if name not in SKIPPED_FOLDERS]
        names += [os.path.relpath(os.path.join(folder, name), ROOT) for name in files]
    return names


def cpp_files():
    return [name for name in tracked_files() if name.endswith((".cpp", ".hpp"))]


def read(name):
    with open(os.path.join(ROOT, name), encoding="utf-8") as file:
        return file.read()


def finish(check, offences, looked_at):
    """Prints every offence and one closing line; exits 1 when there are any."""
    for offence in offences:
        print(offence)
    verdict = f"{len(offences)} offences" if offences else "ok"
    print(f"{check}: {verdict} ({looked_at})")
    sys.exit(1 if offences else 0)
