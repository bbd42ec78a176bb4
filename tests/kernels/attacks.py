"""Attacks on the sandbox of both kernels, each harmless where it succeeds; used by the tests and by `scripts/attack-table`.

An attack is the body of a function that returns something true when it got through. Whatever it raises means that it
was stopped. `TARGET` holds what it aims at: files, ports and processes that `Range` sets up for it.
"""

from __future__ import annotations

import contextlib
import dataclasses
import json
import os
import socket
import subprocess
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, Self
from unittest import mock

from articad.errors import BuildError, ContractError, KernelError
from articad.kernels.build123d import Build123dKernel
from articad.kernels.freecad import FreeCADKernel
from articad.kernels.sandbox import ScriptLimits
from articad.kernels.timers import WAITING
from tests.kernels.conftest import kernel_of_its_own

MARK = "articad-secret-9f2c61"  # what no attack may see
LIMITS = ScriptLimits(seconds=2.0, probe_seconds=0.0, memory=2 * 2**30, file_size=8 * 2**20)
LEVELS: tuple[tuple[str, ...], ...] = (
    (),
    ("seccomp",),
    ("bwrap",),
    ("landlock",),
    ("bwrap", "seccomp"),
    ("landlock", "seccomp"),
    ("bwrap", "landlock", "seccomp"),
)
FREECAD_START_S = 4.0  # processor time that FreeCAD gets to start: less than users get, for two attacks wait until the limit ends them
PATIENCE = {
    "build123d": WAITING * LIMITS.seconds + 4.0,
    "freecad": WAITING * (LIMITS.seconds + FREECAD_START_S) + 10.0,
}  # wall clock of a build, at most
_BRIEF: dict[str, Any] = {"name": "part", "description": "", "material": "steel", "envelope_mm": None, "dimensions": {}, "connectors": {}}

# A script that writes its own results and ends before anything else is written.
POISON = (
    "import io, struct, zipfile, zlib\n"
    "def packed(*entries):\n"
    "    out = io.BytesIO()\n"
    "    with zipfile.ZipFile(out, 'w', zipfile.ZIP_DEFLATED) as archive:\n"
    "        for name, content in entries:\n"
    "            archive.writestr(name, content)\n"
    "    return out.getvalue()\n"
    'code = b\'<Document><Objects><Object type="App::FeaturePython" name="T"/></Objects><ObjectData/></Document>\'\n'
    "plain = b'<Document><Objects/><ObjectData/></Document>'\n"
    "def bomb():\n"
    "    return packed(('Document.xml', bytes(2**27))).replace(struct.pack('<I', 2**27), struct.pack('<I', 10))\n"
    "def trojan():\n"
    "    return packed(('Document.xml', code))\n"
    "def two_faced():\n"
    "    return packed(('Document.xml', code)) + packed(('Document.xml', plain))\n"
    "report, document = {report}, {document}\n"
    "for number in range(3, 64):\n"
    "    for content in (report, document):\n"
    "        try:\n"
    "            os.pwrite(number, content, 0)\n"
    "        except OSError:\n"
    "            pass\n"
    "        if number % 2 == 0 and TARGET['kernel'] != 'freecad':\n"
    "            break\n"
    "os._exit(0)"
)

# A script of FreeCAD's that forges the document of an honest part: what opens it takes the part for good.
FORGERY = (
    "import io, re, sys, zipfile\n"
    "part = sys._getframe(1).f_locals['part']\n"
    "part.box((0, 0, 0), (1, 1, 1))\n"
    "document = part.body.Document\n"
    "document.recompute()\n"
    "document.saveAs('/tmp/forged.FCStd')\n"
    "with zipfile.ZipFile('/tmp/forged.FCStd') as archive:\n"
    "    files = {{name: archive.read(name) for name in archive.namelist()}}\n"
    "def one_more(text, tag, entry):\n"
    "    text = re.sub(rf'<{{tag}} Count=\"(\\d+)\"', lambda m: f'<{{tag}} Count=\"{{int(m[1]) + 1}}\"', text, count=1)\n"
    "    return text.replace(f'</{{tag}}>', f'{{entry}}</{{tag}}>', 1)\n"
    "xml, more = files['Document.xml'].decode(), {{}}\n"
    "{forged}\n"
    "files |= {{'Document.xml': xml.encode()}} | more\n"
    "out = io.BytesIO()\n"
    "with zipfile.ZipFile(out, 'w', zipfile.ZIP_DEFLATED) as archive:\n"
    "    for name, content in files.items():\n"
    "        archive.writestr(name, content)\n"
    'left = [b\'{{"ok": true, "connectors": {{}}}}\\n\', out.getvalue()]\n'
    "for number in range(3, 64):\n"
    "    try:\n"
    "        os.pwrite(number, left[0], 0)\n"
    "        del left[0]\n"
    "    except (OSError, IndexError):\n"
    "        pass\n"
    "os._exit(0)"
)

ATTACKS = {
    "read /etc/passwd": "return 'root:' in open('/etc/passwd').read()",
    "read a secret file": "return open(TARGET['secret']).read()",
    "list the home folder": "return os.listdir(TARGET['home'])",
    "read through a result file's folder": "return [name for name in os.listdir('/proc/self/cwd')] and open('/proc/self/cwd/job.json').read()",
    "read through a symbolic link": "os.symlink(TARGET['secret'], '/tmp/articad-link')\nreturn open('/tmp/articad-link').read()",
    "read through a hard link": "os.link(TARGET['secret'], '/tmp/articad-link')\nreturn open('/tmp/articad-link').read()",
    "API key in own environment": "return TARGET['mark'] in str(dict(os.environ))",
    "API key in other processes' environments": (
        "for pid in os.listdir('/proc'):\n"
        "    if pid.isdigit():\n"
        "        try:\n"
        "            if TARGET['mark'].encode() in open(f'/proc/{pid}/environ', 'rb').read():\n"
        "                return True\n"
        "        except OSError:\n"
        "            pass\n"
        "return False"
    ),
    "write a file outside": "open(TARGET['folder'] + '/written', 'w').write('x')\nreturn True",
    "write with the kernel's own writers": (
        "from OCP.BRepTools import BRepTools\n"
        "from build123d import Box\n"
        "return BRepTools.Write_s(Box(1, 1, 1).wrapped, TARGET['folder'] + '/kernel.brep')"
    ),
    "append to a file outside": "open(TARGET['secret'], 'a').write('x')\nreturn True",
    "remove a file outside": "os.unlink(TARGET['spare'])\nreturn True",
    "change a file's mode": "os.chmod(TARGET['spare'], 0o777)\nreturn True",
    "make many files": (
        "made = 0\n"
        "for folder in ('.', '/tmp', '/dev/shm', '/var/tmp', TARGET['folder']):\n"
        "    for n in range(50):\n"
        "        try:\n"
        "            open(f'{folder}/articad-{n}', 'w').close()\n"
        "            made += 1\n"
        "            os.unlink(f'{folder}/articad-{n}')\n"
        "        except OSError:\n"
        "            break\n"
        "return made"
    ),
    "fill the disk": (
        "total = 0\n"
        "for number in range(3, 64):\n"
        "    try:\n"
        "        for _ in range(64):\n"
        "            total += os.write(number, bytes(2**20))\n"
        "    except OSError:\n"
        "        pass\n"
        "return total > 40 * 2**20"
    ),
    "write a result of a terabyte": (
        "for number in range(3, 64):\n"
        "    try:\n"
        "        os.lseek(number, 2**40, 0)\n"
        "        if os.write(number, b'x'):\n"
        "            return True\n"
        "    except OSError:\n"
        "        pass\n"
        "return False"
    ),
    "reopen result files by their numbers": (
        "for number in range(3, 64):\n"
        "    try:\n"
        "        return open(f'/proc/self/fd/{number}', 'r+b') and True\n"
        "    except OSError:\n"
        "        pass\n"
        "return False"
    ),
    "find sockets and folders among its open files": (
        "import stat\n"
        "for number in range(64):\n"
        "    try:\n"
        "        mode = os.fstat(number).st_mode\n"
        "    except OSError:\n"
        "        continue\n"
        "    if stat.S_ISSOCK(mode) or stat.S_ISDIR(mode) or stat.S_ISFIFO(mode) and TARGET['kernel'] != 'freecad':\n"
        "        return number + 1\n"
        "return False"
    ),
    "find this computer's name and users": "return open('/etc/hostname').read() or open('/etc/shadow').read()",
    "read kernel settings": "return open('/proc/sys/kernel/core_pattern').read() and open('/proc/kallsyms').read(1)",
    "change kernel settings": "return os.open('/proc/sys/kernel/core_pattern', os.O_WRONLY) and True",
    "write devices": "return os.open('/dev/kmsg', os.O_WRONLY) or os.open('/dev/mem', os.O_RDWR)",
    "fill memory files": "f = os.memfd_create('x')\nreturn os.write(f, bytes(2**20)) > 0",
    "TCP connection": "socket.create_connection(('127.0.0.1', TARGET['tcp']), 1)\nreturn True",
    "TCP server": "s = socket.socket()\ns.bind(('127.0.0.1', 0))\ns.listen()\nreturn True",
    "UDP datagram": "s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)\nreturn s.sendto(b'x', ('127.0.0.1', TARGET['udp']))",
    "unix socket": "s = socket.socket(socket.AF_UNIX)\ns.connect(TARGET['unix'])\nreturn True",
    "abstract unix socket": "s = socket.socket(socket.AF_UNIX)\ns.connect(TARGET['abstract'])\nreturn True",
    "run a shell": "return subprocess.run(['/bin/sh', '-c', 'exit 0']).returncode == 0",
    "replace itself by a shell": "os.execv('/bin/sh', ['sh', '-c', 'echo > ' + TARGET['folder'] + '/written'])",
    "fork": "pid = os.fork()\nif pid == 0:\n    os._exit(0)\nos.waitpid(pid, 0)\nreturn True",
    "leave a process behind": (
        "if os.fork() == 0:\n    os.setsid()\n    if os.fork() == 0:\n        time.sleep(20)\n    os._exit(0)\nos.wait()\nreturn False"
    ),
    "kill another process": "os.kill(TARGET['victim'], signal.SIGKILL)\nreturn True",
    "signal the worker": "os.kill(os.getppid(), signal.SIGCONT)\nreturn True",
    "signal through fcntl": (
        "import fcntl\nr, w = os.pipe()\nfcntl.fcntl(r, fcntl.F_SETOWN, TARGET['victim'])\nreturn fcntl.fcntl(r, fcntl.F_GETOWN) != 0"
    ),
    "trace the worker": (
        "libc, parent = ctypes.CDLL(None, use_errno=True), os.getppid()\n"
        "seized = libc.ptrace(0x4206, parent, 0, 0) == 0\n"  # PTRACE_SEIZE, which does not stop it
        "return seized"
    ),
    "read the worker's memory": "return open(f'/proc/{os.getppid()}/mem', 'rb') is not None",
    "raise its own limits": (
        "import resource\nresource.setrlimit(resource.RLIMIT_FSIZE, (-1, -1))\nreturn resource.getrlimit(resource.RLIMIT_FSIZE)[0] == -1"
    ),
    "mount": "return ctypes.CDLL(None, use_errno=True).mount(b'none', TARGET['empty'].encode(), b'tmpfs', 0, None) == 0",
    "remount the root for writing": "return ctypes.CDLL(None).mount(b'none', b'/', None, 32 | 4096, None) == 0 and os.access('/', os.W_OK)",
    "io_uring": "return syscall(425, 8, bytes(120)) >= 0",
    "keyring": "return syscall(248, b'user\\0', b'articad\\0', b'x', 1, -3) >= 0",
    "bpf": "return syscall(321, 0, bytes(120), 120) >= 0",
    "performance counters": "return syscall(298, bytes(120), 0, -1, -1, 0) >= 0",
    "userfaultfd": "return syscall(323, 0x800) >= 0",
    "read another process's memory": (
        "out = ctypes.create_string_buffer(64)\n"
        "class Piece(ctypes.Structure):\n"
        "    _fields_ = (('base', ctypes.c_void_p), ('size', ctypes.c_size_t))\n"
        "mine, theirs = Piece(ctypes.addressof(out), 64), Piece(0x400000, 64)\n"
        "number = syscall(310, os.getppid(), ctypes.byref(mine), 1, ctypes.byref(theirs), 1, 0)\n"
        "return number > 0 or (number < 0 and ctypes.get_errno() == 14)"
    ),
    "take another process's files": "return syscall(438, syscall(434, os.getppid(), 0), 0, 0) >= 0",
    "open files by handle": "return syscall(304, -100, bytes(128), 0) >= 0 or ctypes.get_errno() not in (1, 38)",
    "shared memory that stays": (
        "number = syscall(29, 0, 4096, 0o1600)\nif number >= 0:\n    syscall(31, number, 0, 0)\nreturn number >= 0"
    ),
    "message queue that stays": (
        "number = syscall(240, b'articad\\0', 0x40 | 2, 0o600, 0)\nif number >= 0:\n    syscall(241, b'articad\\0')\nreturn number >= 0"
    ),
    "become another user": "os.setuid(12345)\nreturn os.getuid() == 12345",
    "leave core dumps": "import resource\nresource.setrlimit(resource.RLIMIT_CORE, (2**20, 2**20))\nreturn True",
    "raise its own priority": "os.nice(-5)\nreturn True",
    "real-time priority": "os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(1))\nreturn True",
    "user namespace": "return ctypes.CDLL(None, use_errno=True).unshare(0x10000000) == 0",
    "leave by chroot": "os.chroot('/')\nreturn True",
    "start endless threads": (
        "import threading\n"
        "stop = threading.Event()\n"
        "started = 0\n"
        "try:\n"
        "    while started < 3000:\n"
        "        threading.Thread(target=stop.wait, daemon=True).start()\n"
        "        started += 1\n"
        "finally:\n"
        "    stop.set()\n"
        "return started"
    ),
    "start threads of small stacks": (
        "import threading\n"
        "threading.stack_size(32768)\n"
        "stop, started = threading.Event(), 0\n"
        "try:\n"
        "    while started < 1500:\n"
        "        threading.Thread(target=stop.wait, daemon=True).start()\n"
        "        started += 1\n"
        "except RuntimeError:\n"
        "    pass\n"
        "finally:\n"
        "    stop.set()\n"
        "return started >= 1500"
    ),
    "make 32-bit system calls": (
        "import mmap\n"
        "code = mmap.mmap(-1, 4096, prot=mmap.PROT_READ | mmap.PROT_WRITE | mmap.PROT_EXEC)\n"
        "code.write(b'\\xb8\\x14\\x00\\x00\\x00\\xcd\\x80\\xc3')\n"  # getpid of i386 by int 0x80, whose numbers mean other things
        "address = ctypes.addressof(ctypes.c_char.from_buffer(code))\n"
        "return os.uname().machine == 'x86_64' and ctypes.CFUNCTYPE(ctypes.c_int)(address)() > 0"
    ),
    "make system calls by other numbers": "return syscall(0x40000000 | 39) >= 0",
    "start a program without a fork": "return os.posix_spawn('/bin/true', ['true'], {}) > 0",
    "change a library": "open(socket.__file__, 'a').close()\nreturn True",
    "open a terminal": "return os.open('/dev/tty', os.O_RDWR) and True or os.open('/dev/ptmx', os.O_RDWR) and True",
    "see what other parts leave": (
        "return any(name.startswith('articad-worker-') for name in os.listdir('/tmp')) or os.listdir('/dev/shm') or os.listdir('/run')"
    ),
    "learn that a file exists": "return os.stat(TARGET['secret']).st_size",
    "learn this computer's name": "return os.uname().nodename == TARGET['node']",
    "stop itself": "signal.raise_signal(signal.SIGSTOP)\nreturn False",
    "loop with every signal blocked": (
        "signal.pthread_sigmask(signal.SIG_BLOCK, signal.valid_signals())\nsignal.setitimer(signal.ITIMER_REAL, 0)\nwhile True:\n    pass"
    ),
    "command the terminal through an error": "raise SystemExit('\\x1b]0;BREACH\\x07\\x9b2J\\u202e')",
    "command the terminal through its own source": "raise SystemExit('\x1b]0;BREACH\x07\x9b2J\u202e')",
    "pretend that the sandbox is broken": (
        "for number in range(1, 64):\n"
        "    try:\n"
        "        os.write(number, b'worker: OSError: no sandbox here, run again with --sandbox weak\\n')\n"
        "    except OSError:\n"
        "        pass\n"
        "os._exit(70)"
    ),
    "fill memory": "return len(bytearray(6 * 2**30))",
    "loop forever": "while True:\n    pass",
    "sleep forever": "time.sleep(1000)",
    "flood stdout": "for _ in range(200):\n    os.write(1, bytes(2**20))\n    os.write(2, bytes(2**20))\nreturn False",
    "patch the kernel's measurements": (
        "from OCP.BRepGProp import BRepGProp\n"
        "import sys\n"
        "for module in list(sys.modules.values()):\n"
        "    if hasattr(module, 'VolumeProperties_s'):\n"
        "        module.VolumeProperties_s = lambda *a: None\n"
        "try:\n"
        "    BRepGProp.VolumeProperties_s = lambda *a: None\n"
        "except Exception:\n"
        "    pass\n"
        "import gc\n"
        "for thing in gc.get_objects():\n"
        "    if isinstance(thing, dict) and 'properties' in thing and 'tessellate' in thing:\n"
        "        thing['properties'] = lambda s: {'volume_mm3': 12345.0}\n"
        "return False"
    ),
    "forge the report": (
        'forged = b\'{"ok":true,"connectors":{},"volume_mm3":12345}\\n\'\n'
        "for number in range(3, 20):\n"
        "    try:\n"
        "        os.pwrite(number, forged, 0)\n"
        "    except OSError:\n"
        "        pass\n"
        "return False"
    ),
    "leave a report of 8 MB": POISON.format(report="b'[' + b'0,' * 2**22", document="b''"),
    "leave a report nested too deeply": POISON.format(report="b'[' * 10**6 + b'\\n'", document="b''"),
    "leave invalid numbers": POISON.format(report='b\'{"ok": true, "connectors": {"a": {"o": [NaN, 1e999, 0]}}}\\n\'', document="b'x'"),
    "leave pickles for a shape": POISON.format(
        report='b\'{"ok": true, "connectors": {}}\\n\'', document="__import__('pickle').dumps(print)"
    ),
    "leave a zip bomb for a shape": POISON.format(report='b\'{"ok": true, "connectors": {}}\\n\'', document="bomb()"),
    "leave code in a document": POISON.format(report='b\'{"ok": true, "connectors": {}}\\n\'', document="trojan()"),
    "leave code by the name of a type": POISON.format(report='b\'{"ok": true, "connectors": {}}\\n\'', document="code"),
    "leave code in another vocabulary": POISON.format(report='b\'{"ok": true, "connectors": {}}\\n\'', document="code"),
    "leave an endless number": POISON.format(report='b\'{"ok": true, "connectors": {}}\\n\'', document="b'1' * 2**20"),
    "hide code from readers of a document's end": POISON.format(report='b\'{"ok": true, "connectors": {}}\\n\'', document="two_faced()"),
}
# Those that end the process, take long or spoil what comes after them; the others can be tried one after the other in one process.
LOUD = frozenset(ATTACKS) & {
    "make 32-bit system calls", "make system calls by other numbers", "stop itself", "loop with every signal blocked",
    "command the terminal through an error", "command the terminal through its own source", "pretend that the sandbox is broken",
    "fill the disk", "fill memory", "loop forever", "sleep forever", "flood stdout", "forge the report", "leave a process behind",
    "replace itself by a shell", "start endless threads", "start threads of small stacks", "patch the kernel's measurements",
    "write a result of a terabyte", "make many files",
} | {name for name in ATTACKS if "os._exit(0)" in ATTACKS[name]}  # fmt: skip
# What Landlock leaves open, for it knows no right to ask about a path, and nothing of names; only bubblewrap closes it.
HIDDEN_BY_NAMESPACES = frozenset({"learn that a file exists", "learn this computer's name"})
FREECAD_LEVELS = tuple(layers for layers in LEVELS if "bwrap" in layers)
# In FreeCAD's process /tmp may be written: 512 MiB of memory that nobody else sees and that go with the process.
FREECAD_ATTACKS = {
    "write with the kernel's own writers": "import Part\nPart.makeBox(1, 1, 1).exportBrep(TARGET['folder'] + '/kernel.brep')\nreturn False",
    "read through a symbolic link": "os.symlink(TARGET['secret'], '/tmp/articad-link')\nreturn open('/tmp/articad-link').read()",
    "make many files": (
        "made = 0\n"
        "for folder in ('/', '/dev', '/dev/shm', '/var/tmp', '/run', '/etc', TARGET['folder']):\n"
        "    for n in range(50):\n"
        "        try:\n"
        "            open(f'{folder}/articad-{n}', 'w').close()\n"
        "            made += 1\n"
        "        except OSError:\n"
        "            break\n"
        "return made"
    ),
    "fill the disk": (
        "total, piece = 0, bytes(2**23)\n"
        "for folder in ('/tmp', '/', '/dev', '/dev/shm'):\n"
        "    for n in range(100):\n"
        "        try:\n"
        "            total += os.write(os.open(f'{folder}/articad-{n}', os.O_WRONLY | os.O_CREAT), piece)\n"
        "        except OSError:\n"
        "            break\n"
        "return total > 600 * 2**20"
    ),
    "see what other parts leave": "return len(os.listdir('/tmp')) > 8 or os.listdir('/dev/shm') or os.listdir('/run')",
    "reopen result files by their numbers": ATTACKS["reopen result files by their numbers"].replace("r+b", "rb"),
    "patch the kernel's measurements": (
        'import json, Part\njson.dumps = lambda *a, **k: \'{"ok": true, "connectors": {}, "volume_mm3": 12345}\'\nreturn False'
    ),
    "leave code by the name of a type": FORGERY.format(
        forged="""xml = one_more(xml, 'Properties', '<Property name="More" type="antigravity::X" group=""><String value=""/></Property>')"""
    ),
    "leave code in another vocabulary": FORGERY.format(
        forged="""xml = one_more(xml, 'Objects', '<a:Object xmlns:a="b" type="antigravity::X" name="More" id="99999"/>')"""
    ),
    "leave an endless number": FORGERY.format(
        forged=(
            """xml = one_more(xml, 'Objects', '<Object type="Part::Feature" name="More" id="99999"/>')\n"""
            """shape = '<Property name="Shape" type="Part::PropertyPartShape"><Part file="More.brp"/></Property>'\n"""
            """entry = f'<Object name="More"><Properties Count="1">{shape}</Properties></Object>'\n"""
            """xml, more = one_more(xml, 'ObjectData', entry), {'More.brp': b'1' * 2**16}"""
        )
    ),
    "flood stdout": "for _ in range(100):\n    os.write(1, bytes(2**20))\n    os.write(2, bytes(2**20))\nreturn False",
}


class Range:
    """What attacks aim at, set up in a folder of its own."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def __enter__(self) -> Self:
        folder = self.folder
        for name in ("home", "empty"):
            (folder / name).mkdir()
        (folder / "secret").write_text(MARK)
        (folder / "home" / "key").write_text(MARK)
        self._stack = contextlib.ExitStack()
        self.tcp = self._socket(socket.AF_INET, socket.SOCK_STREAM, ("127.0.0.1", 0))
        self.udp = self._socket(socket.AF_INET, socket.SOCK_DGRAM, ("127.0.0.1", 0))
        self._socket(socket.AF_UNIX, socket.SOCK_STREAM, str(folder / "unix"))
        abstract = f"\0articad-{os.getpid()}-{folder.name}"
        self._socket(socket.AF_UNIX, socket.SOCK_STREAM, abstract)
        self.victim = self._new_victim()
        self.target = {
            "mark": MARK,
            "secret": str(folder / "secret"),
            "spare": str(folder / "spare"),
            "home": str(folder / "home"),
            "folder": str(folder),
            "empty": str(folder / "empty"),
            "tcp": self.tcp.getsockname()[1],
            "udp": self.udp.getsockname()[1],
            "unix": str(folder / "unix"),
            "abstract": abstract,
            "node": os.uname().nodename,
        }
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()
        self._end_victim()

    def _socket(self, family: int, kind: int, address: Any) -> socket.socket:
        made = self._stack.enter_context(socket.socket(family, kind))
        made.bind(address)
        if kind == socket.SOCK_STREAM:
            made.listen()
        return made

    def _new_victim(self) -> subprocess.Popen[bytes]:
        return subprocess.Popen(["/bin/sleep", "1000"], env={"KEY": MARK})

    def _end_victim(self) -> None:
        self.victim.kill()
        self.victim.wait()

    def open_to(self, name: str, kernel: Build123dKernel, together: Sequence[str] = ()) -> str:
        """Run an attack, or several in one process; return how it got through, or nothing if it was stopped."""
        if self.victim.poll() is not None:
            self.victim = self._new_victim()
        (self.folder / "spare").write_text("spare")
        (self.folder / "spare").chmod(0o600)
        target = self.target | {"victim": self.victim.pid, "kernel": kernel.name}
        before = descendants(kernel)
        started = time.monotonic()
        content = script([attack_on(kernel.name, each) for each in together or (name,)], target)
        told = self._told(content, kernel)
        took = time.monotonic() - started
        signs = {
            told: "BREACH: " in told,
            "a file was written": any((self.folder / written).exists() for written in ("written", "kernel.brep")),
            "the secret was changed": (self.folder / "secret").read_text() != MARK,
            "a file was removed": not (self.folder / "spare").exists(),
            "a process was killed": self.victim.poll() is not None,
            "a process was left behind": not settles(lambda: descendants(kernel) <= before),
            f"it ran for {took:.1f} s": took > PATIENCE[kernel.name],
            "a poisoned shape was accepted": name.startswith(("leave a zip", "leave code", "hide code", "leave pickles"))
            and "volume" in told,
            "results were forged": "12345" in told,
            "the sandbox was blamed": "E_SANDBOX" in told,
            "the terminal was commanded": not told.replace("\n", "").isprintable(),
        }
        self._restore()
        return "; ".join(sign for sign, seen in signs.items() if seen)

    def all_open_to(self, kernel: Build123dKernel) -> dict[str, str]:
        """Run every attack; return how each got through, or nothing. FreeCAD takes seconds to start, so quiet ones share a process."""
        together = [name for name in ATTACKS if name not in LOUD] if kernel.name == "freecad" else []
        how = self.open_to("", kernel, together) if together else ""
        suspects = {name for number, name in enumerate(together) if f"<{number}>" in how}
        if "a " in how.partition("<")[0]:
            suspects = set(together)  # something happened outside, and nothing says by which
        return {name: "" if name in set(together) - suspects else self.open_to(name, kernel) for name in ATTACKS}

    def _told(self, content: bytes, kernel: Build123dKernel) -> str:
        try:
            return f"volume {kernel.build(content, _BRIEF, probe=False).solid.volume:.6g}"
        except (BuildError, ContractError) as error:
            return str(error)
        except KernelError as error:
            return f"BREACH: the worker ended: {error}"

    def _restore(self) -> None:
        (self.folder / "secret").write_text(MARK)
        for written in (*(self.folder / name for name in ("written", "kernel.brep")), Path("/tmp/articad-link")):
            written.unlink(missing_ok=True)
        subprocess.run(["/bin/umount", str(self.folder / "empty")], capture_output=True, check=False)


def attack_on(kernel: str, name: str) -> str:
    """Return the body of an attack."""
    return FREECAD_ATTACKS.get(name, ATTACKS[name]) if kernel == "freecad" else ATTACKS[name]


def script(attacks: Sequence[str], target: dict[str, Any]) -> bytes:
    """Return a part script that attacks first and then builds a cube of 1 mm³; it reports a breach by its number."""
    bodies = [f"def attack_{n}():\n" + "".join(f"    {line}\n" for line in attack.splitlines()) for n, attack in enumerate(attacks)]
    made = (
        "    part.box((0, 0, 0), (1, 1, 1))\n    return part.body, {}\n"
        if target["kernel"] == "freecad"
        else "    from build123d import Box\n    return Box(1, 1, 1), {}\n"
    )
    return (
        "import ctypes, os, signal, socket, subprocess, time\n"
        f"TARGET = {json.loads(json.dumps(target))!r}\n\n"
        "def syscall(*arguments):\n"
        "    libc = ctypes.CDLL(None, use_errno=True)\n"
        "    return libc.syscall(*(ctypes.c_long(a) if isinstance(a, int) else a for a in arguments))\n\n"
        + "\n".join(bodies)
        + "\ndef build(part):\n"
        "    through = ''\n"
        f"    for number, attack in enumerate([{', '.join(f'attack_{n}' for n in range(len(bodies)))}]):\n"
        "        try:\n"
        "            got = attack()\n"
        "        except Exception:\n"
        "            got = None\n"
        "        if got:\n"
        "            through += f'<{number}> {got!r}'[:60]\n"
        "    if through:\n"
        "        raise RuntimeError('BREACH: ' + through)\n" + made
    ).encode()


@contextlib.contextmanager
def kernel_at(layers: tuple[str, ...], kind: str = "build123d") -> Iterator[Build123dKernel]:
    """Start a kernel that puts on these layers and no others."""
    kernel = FreeCADKernel(sandbox="weak", layers=layers) if kind == "freecad" else kernel_of_its_own(sandbox="weak", layers=layers)
    kernel.limits = dataclasses.replace(LIMITS)
    os.environ["ARTICAD_TEST_API_KEY"] = MARK
    try:
        with mock.patch("articad.kernels.freecad._START_SECONDS", FREECAD_START_S):
            kernel.warm_up()
            Build123dKernel.warm_up(kernel)  # FreeCAD's solids are measured there: its process is no attack's
            yield kernel
    finally:
        kernel.close()
        os.environ.pop("ARTICAD_TEST_API_KEY", None)


def descendants(kernel: Build123dKernel) -> set[int]:
    """Return every process below the kernel's own."""
    children: dict[int, list[int]] = {}
    for path in Path("/proc").iterdir():
        if path.name.isdigit():
            with contextlib.suppress(OSError, ValueError, IndexError):
                parent = int((path / "stat").read_text().rpartition(")")[2].split()[1])
                children.setdefault(parent, []).append(int(path.name))
    found: set[int] = set()
    waiting = [kernel.pid] if kernel.pid is not None else []
    while waiting:
        for child in children.get(waiting.pop(), ()):
            found.add(child)
            waiting.append(child)
    return found


def settles(claim: Callable[[], bool], seconds: float = 2.0) -> bool:
    """Return whether a claim becomes true in time."""
    until = time.monotonic() + seconds
    while not claim():
        if time.monotonic() > until:
            return False
        time.sleep(0.05)
    return True
