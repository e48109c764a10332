# SPDX-License-Identifier: Apache-2.0
"""lumen run by run in one process, which costs a tenth of starting it each time."""
import dataclasses, json, os, subprocess, threading


@dataclasses.dataclass
class Run:
    """As of subprocess.run()."""
    returncode: int
    stdout: str
    stderr: str


class Program:
    """The program itself, started for each run."""
    def __init__(self, program, **how):
        self.program, self.how = str(program), how

    def run(self, arguments, folder, merged=False):
        done = subprocess.run([self.program, *map(str, arguments)], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT if merged else subprocess.PIPE, text=True, **self.how)
        return Run(done.returncode, done.stdout, done.stderr or "")


class Batch:
    """The test program batch_lumen. A run that crashes it is answered with minus the signal, and the next run starts it again."""
    def __init__(self, program, seconds=300, **how):
        self.program, self.seconds, self.how, self.process = str(program), seconds, how, None

    def run(self, arguments, folder, merged=False):
        """`merged`: stdout has both streams in their order. A run that takes too long is killed: minus SIGKILL."""
        if self.process is None:
            self.process = subprocess.Popen([self.program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, **self.how)
        asked = dict(arguments=[str(a) for a in arguments], folder=os.fspath(folder), merged=merged)
        timer = threading.Timer(self.seconds, self.process.kill)
        timer.start()
        self.process.stdin.write(json.dumps(asked) + "\n")
        self.process.stdin.flush()
        line = self.process.stdout.readline()
        timer.cancel()
        if not line:
            self.process.stdin.close()
            code, self.process = self.process.wait(), None
            return Run(code, "", "")
        answer = json.loads(line)
        return Run(answer["code"], answer["out"], answer["err"])

    def end(self):
        if self.process is None: return
        self.process.stdin.close()
        self.process.wait()
