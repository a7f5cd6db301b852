"""Types into real shells, presses the tabulator, and reads what words the line has then.

shells.py TOOL: exit code 1, and what differs, where a shell completes something else than it should.
"""
import os
import pty
import select
import signal
import subprocess
import sys
import tempfile
import time

CASES = [  # what is typed, and the words of the line then
    ("emit steep_parallax -T glsl_4\t", ["emit", "steep_parallax", "-T", "glsl_450"]),
    ("emit --target=hlsl_5\t", ["emit", "--target=hlsl_5_0"]),
    ("emit -Thlsl_5\t", ["emit", "-Thlsl_5_0"]),
    ("emit steep_parallax,shado\tma\t-T none", ["emit", "steep_parallax,shadow=march", "-T", "none"]),
    ("emit parallax_occlusion -D tap\t12", ["emit", "parallax_occlusion", "-D", "taps=12"]),
    ("bake rel\t", ["bake", "relaxed-cone"]),
    ("check --format ju\t", ["check", "--format", "junit"]),
    ("run x --maker bri\t", ["run", "x", "--maker", "bricks"]),
    ("run x --hei\tbri\t", ["run", "x", "--height", "brick wall.png"]),
    ("run x --baked relaxed-cone=bri\t", ["run", "x", "--baked", "relaxed-cone=brick wall.png"]),
    ("measure sce\t-o res\t", ["measure", "scene.toml", "-o", "results"]),
]
SECONDS = 60  # for one line; it takes some milliseconds on a quiet machine


def write(path, text):
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


class Shell:
    """A shell at a terminal, in a folder with a map, a scene, a folder of results, and files that do not fit."""

    def __init__(self, command, start, folder):
        self.said = os.path.join(folder, "said")
        child, self.terminal = pty.fork()
        if child == 0:
            os.chdir(folder)
            os.execvpe(command[0], command, dict(os.environ, TERM="dumb", HOME=folder, HISTFILE=""))
        self.child = child
        # The words of the line as files of its own: nothing has to be read from the screen.
        self.send(f"said() {{ printf '%s\\n' \"$@\" >'{self.said}.part'; mv '{self.said}.part' '{self.said}'; }}\n")
        for line in start:
            self.send(line + "\n")

    def send(self, keys):
        os.write(self.terminal, keys.encode())

    def words_after(self, typed):
        if os.path.exists(self.said):
            os.unlink(self.said)
        self.send("intaglio " + typed)
        self.send("\x01said \n")  # to the line's start
        screen, end = b"", time.monotonic() + SECONDS
        while not os.path.exists(self.said):
            if time.monotonic() > end:
                sys.exit(f"no answer to {typed!r}; the screen:\n{screen.decode(errors='replace')}")
            if select.select([self.terminal], [], [], 0.02)[0]:
                screen += os.read(self.terminal, 4096)
        with open(self.said, encoding="utf-8") as file:
            return [word.rstrip("/") for word in file.read().split("\n")[1:-1]]

    def close(self):
        os.kill(self.child, signal.SIGKILL)
        os.waitpid(self.child, 0)
        os.close(self.terminal)


def main():
    tool = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        for name in ("brick wall.png", "bricks.txt", "scene.toml", "scene.json"):
            write(os.path.join(folder, name), "")
        os.mkdir(os.path.join(folder, "results"))
        write(os.path.join(folder, "results.txt"), "")
        functions = os.path.join(folder, "functions")
        os.mkdir(functions)
        bash_script = os.path.join(functions, "intaglio")
        for shell, path in (("bash", bash_script), ("zsh", os.path.join(functions, "_intaglio"))):
            subprocess.run([tool, "completion", shell, "--program", "intaglio", "-o", path], check=True)
        programs = os.path.join(folder, "programs")
        os.mkdir(programs)
        os.symlink(tool, os.path.join(programs, "intaglio"))
        os.environ["PATH"] = programs + ":" + os.environ["PATH"]
        shells = {
            "bash": (["bash", "--norc", "--noprofile", "-i"], [f". '{bash_script}'", "bind 'set bell-style none'"]),
            "zsh": (["zsh", "-f", "-i"], [f"fpath=('{functions}' $fpath)", "autoload -Uz compinit", "compinit -u -D",
                                          "unsetopt beep", "bindkey -e"]),
        }
        wrong = 0
        for name, (command, start) in shells.items():
            shell = Shell(command, start, folder)
            for typed, expected in CASES:
                words = shell.words_after(typed)
                if words != expected:
                    wrong += 1
                    print(f"{name}: {typed!r} became {words}, expected {expected}")
            shell.close()
        print(f"{len(shells) * len(CASES)} lines completed, {wrong} wrong")
        return 1 if wrong else 0


sys.exit(main())
