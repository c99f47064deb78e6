"""A copy of the package for the reader of a page: to write into, with its build, its own master and ports."""

import os
import pathlib
import shutil
import socket
import subprocess

PATIENCE = {"joint_sensor.yaml": "5.0", "coil_driver.yaml": "1.0"}  # [s] of an answer, on however busy a computer
COPIED = ("devel", "Testing")  # of the build; all else is the one that is tested


def free_ports(count):
    """Ports that differ."""
    sockets = [socket.create_server(("", 0)) for _ in range(count)]
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


def copy_of_package(source, build, root):
    """The sources in root/package, and the build below them as scripts/build makes it. Returns the folder."""
    package = root / "package"
    left_out = {str(build), str(source / ".git")}
    shutil.copytree(
        source,
        package,
        ignore=lambda folder, names: [name for name in names if os.path.join(folder, name) in left_out],
        symlinks=True,
    )
    (package / "build").mkdir()
    copy_devel(build / "devel", package / "build" / "devel", {str(build): str(package / "build"), str(source): str(package)})
    for file in build.iterdir():
        if file.name not in COPIED:
            (package / "build" / file.name).symlink_to(file)
    set_ports(package / "config")
    return package


def copy_devel(devel, copy, places):
    """The devel space at another place: programs are links, texts name the new places."""
    for folder, _, files in os.walk(devel):
        target = copy / pathlib.Path(folder).relative_to(devel)
        target.mkdir(parents=True)
        for name in files:
            file = pathlib.Path(folder) / name
            content = file.read_bytes()
            if b"\0" in content[:4096]:
                (target / name).symlink_to(file)
                continue
            text = content.decode()
            for old, new in places.items():
                text = text.replace(old, new)
            (target / name).write_text(text)
            shutil.copymode(file, target / name)


def set_ports(config):
    """Other laboratories may run on this computer, and keep it busy."""
    for (name, timeout), port in zip(PATIENCE.items(), free_ports(len(PATIENCE))):
        lines = (config / name).read_text().splitlines()
        for key, value in (("port", port), ("response_timeout", timeout)):
            places = [number for number, line in enumerate(lines) if line.startswith(f"  {key}: ")]
            assert len(places) == 1, f"{name}: {key} stands at {places}"
            lines[places[0]] = f"  {key}: {value}"
        (config / name).write_text("\n".join(lines) + "\n")


def environment_of(package, root):
    """What a terminal has after `source build/devel/setup.bash`, with a home and a master of its own."""
    home = root / "home"
    home.mkdir(exist_ok=True)
    plain = {
        "PATH": "/usr/bin:/bin:/usr/sbin:/sbin",
        "HOME": str(home),
        "ROS_HOME": str(home / ".ros"),
        "ROS_MASTER_URI": f"http://localhost:{free_ports(1)[0]}",
        "LANG": "C.UTF-8",
        "TERM": "dumb",
        "PYTHONUNBUFFERED": "1",
        "PYTHONDONTWRITEBYTECODE": "1",
        "LIBGL_ALWAYS_SOFTWARE": "1",
        "LP_NUM_THREADS": "1",  # of the software that draws for rviz
        "QT_QPA_PLATFORM": "xcb",
    }
    # The master of the page is not what setup.bash would name.
    command = f"source '{package}/build/devel/setup.bash' && ROS_MASTER_URI={plain['ROS_MASTER_URI']} && env -0"
    outcome = subprocess.run(["bash", "-c", command], env=plain, stdout=subprocess.PIPE, text=True, check=True)
    return dict(line.split("=", 1) for line in outcome.stdout.split("\0") if "=" in line)
