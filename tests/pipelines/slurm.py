#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A Slurm of one machine, started and stopped in a folder of its own; needs root, slurm-wlm and munge.

slurm.py COMMAND ARGUMENT...

Runs the command while Slurm runs, and ends with its exit status."""
import os, pathlib, shutil, signal, socket, subprocess, sys, tempfile, time

HERE = pathlib.Path(__file__).resolve().parent
SECONDS = 60


def cannot_start():
    """The reason why no Slurm can be started here, or an empty text."""
    missing = [name for name in ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol", "scancel") if shutil.which(name, path=PATH) is None]
    if missing: return f"no {', '.join(missing)} (apt install slurm-wlm munge)"
    if os.geteuid() != 0: return "slurmd and slurmctld start jobs of other users only as root"
    return ""


PATH = os.environ.get("PATH", "") + ":/usr/sbin:/sbin"


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets: one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets: one.close()
    return ports


def wait_until(holds, what, seconds=SECONDS):
    end = time.monotonic() + seconds
    while not (found := holds()):
        if time.monotonic() > end: raise RuntimeError(f"{what}: not within {seconds} s")
        time.sleep(0.1)
    return found


class Slurm:
    """`with Slurm() as slurm:` the controller and one node; `slurm.environment` is what its users need."""

    def __init__(self, cores=None):
        self.cores = cores or os.cpu_count()
        self.host = socket.gethostname().split(".")[0]

    def __enter__(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="lumen-slurm-"))
        self.folder.chmod(0o755)
        for name in ("state", "spool", "log"): (self.folder / name).mkdir()
        self.environment = {**os.environ, "PATH": PATH, "SLURM_CONF": str(self.folder / "slurm.conf")}
        try:
            self.start()
        except BaseException:
            self.stop()
            raise
        return self

    def __exit__(self, *_): self.stop()

    def start(self):
        ports, total = free_ports(2), os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 2**20
        text = (HERE / "slurm.conf.in").read_text()
        for name, value in (("DIR", self.folder), ("HOST", self.host), ("CORES", self.cores), ("MEGABYTES", total * 3 // 4),
                            ("CONTROLLER_PORT", ports[0]), ("NODE_PORT", ports[1])):
            text = text.replace(f"@{name}@", str(value))
        (self.folder / "slurm.conf").write_text(text)
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o600)
        self.run("munged", f"--key-file={key}", f"--socket={self.folder}/munge.sock", f"--pid-file={self.folder}/munge.pid",
                 f"--log-file={self.folder}/log/munge", f"--seed-file={self.folder}/munge.seed", "--force")
        self.run("slurmctld", "-i")
        wait_until(lambda: self.try_run("scontrol", "ping").returncode == 0, "slurmctld answers")
        self.run("slurmd")
        wait_until(lambda: self.node_state().startswith(("idle", "mix", "alloc")), "the node is ready")

    def stop(self):
        self.try_run("scancel", "--user=root")
        self.try_run("scontrol", "shutdown")
        for name in ("d.pid", "ctld.pid", "munge.pid"): self.end(self.folder / name)
        shutil.rmtree(self.folder, ignore_errors=True)

    def end(self, file):
        """Ends a daemon by the process id that it wrote, if it has not ended by itself."""
        try:
            process = int(file.read_text())
        except (OSError, ValueError):
            return
        for sent in (None, signal.SIGTERM, signal.SIGKILL):
            try:
                if sent is not None: os.kill(process, sent)
                wait_until(lambda: not pathlib.Path(f"/proc/{process}").exists(), "the daemon ends", 10 if sent is None and file.name != "munge.pid" else 3)
                return
            except ProcessLookupError:
                return
            except RuntimeError:
                continue

    def try_run(self, *words):
        return subprocess.run([str(w) for w in words], env=self.environment, capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=SECONDS)

    def run(self, *words):
        done = self.try_run(*words)
        if done.returncode: raise RuntimeError(f"{' '.join(str(w) for w in words)}: {done.returncode}: {done.stdout}{done.stderr}")
        return done.stdout

    def node_state(self): return self.try_run("sinfo", "--noheader", "--format=%T").stdout.strip()


def main():
    if reason := cannot_start(): sys.exit(f"slurm.py: {reason}")
    with Slurm() as cluster:
        return subprocess.run(sys.argv[1:], env=cluster.environment).returncode


if __name__ == "__main__": sys.exit(main())
