"""A folder like a clone of the repository. It has all that examples read, and tells what they leave behind."""
import pathlib
import shutil
import subprocess

FOLDERS = ["scenarios", "schedules", "experiments", "examples"]


def make(folder: pathlib.Path, repository: pathlib.Path, program: pathlib.Path) -> None:
    for name in FOLDERS:
        for file in sorted((repository / name).rglob("*")):
            if file.suffix not in (".yaml", ".csv"):
                continue
            copy = folder / file.relative_to(repository)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(file, copy)
    if (repository / ".gitignore").exists():
        shutil.copy(repository / ".gitignore", folder)
    (folder / "build/release").mkdir(parents=True)
    (folder / "build/release/ttfusion").symlink_to(program)
    git(folder, "init", "--quiet")
    git(folder, "add", "--all")


def litter(folder: pathlib.Path) -> str:
    """Returns the files that are new and not ignored, one a line: `git status` would show them."""
    return git(folder, "ls-files", "--others", "--exclude-standard").strip()


def git(folder: pathlib.Path, *arguments: str) -> str:
    return subprocess.run(["git", "-C", folder, *arguments], check=True, capture_output=True, text=True).stdout
