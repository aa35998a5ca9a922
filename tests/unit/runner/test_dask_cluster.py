"""Workers of Dask: killed, restarted, at an address, or of this machine."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from threading import Thread
from typing import Any

import pytest
import yaml

from lavendersim.errors import UsageError
from lavendersim.experiment import load_experiment
from lavendersim.runner import Progress, Run, run
from tests.runner.run_contents import contents
from tests.runner.small_configs import DROPS, write

MANY = DROPS.replace("[0.2, 0.5, 0.8]", str([round(0.1 + i / 100, 2) for i in range(40)]))


OWN_MEASURE = '''\
from lavendersim.measures import Trace, own_measure
from lavendersim.quantities.names import BodyName


@own_measure
def highest(trace: Trace, body: BodyName) -> float:
    """Greatest height [m] of a body's centre."""
    return float(trace.pose[:, trace.bodies.index(body), 2].max())
'''
EXTENDED = """\
extends: ../base.yaml
measure: {top: {kind: highest, body: ball}}
expect: [{name: it is as high as its start, measure: top, between: [0.149999, 0.150001]}]
"""


@pytest.fixture
def drops(tmp_path: Path) -> Path:
    return write(tmp_path)


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    """Two workers; one that is killed comes again."""
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, processes=True
    ) as started:
        yield started


def part_of_dask(*words: object) -> subprocess.Popen[bytes]:
    """Start a scheduler or a worker of Dask in a process of its own."""
    command = [sys.executable, "-m", *map(str, words), "--no-dashboard"]
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


@pytest.mark.skipif(os.name != "posix", reason="kills as POSIX does")
def test_dask_gives_the_cells_of_a_killed_worker_to_others(cluster: Any, tmp_path: Path) -> None:
    from distributed import Client

    config = write(tmp_path, MANY)
    whole = contents(run(config, tmp_path / "whole").run)
    runs = tmp_path / "runs"
    worker = next(iter(cluster.workers.values()))

    def kill() -> None:
        while len(list(runs.glob("*/cells/[!.]*"))) < 3:
            time.sleep(0.005)
        os.kill(worker.pid, signal.SIGKILL)

    killer = Thread(target=kill, daemon=True)
    killer.start()
    ended: list[tuple[int, int]] = []
    progress = Progress(cell_done=lambda done, total: ended.append((done, total)))
    with Client(cluster, set_as_default=False) as client:
        found = run(config, runs, progress=progress, executor=client.get_executor(pure=False))
    killer.join()
    assert ended == [(done, 40) for done in range(1, 41)]  # every cell once
    assert contents(found.run) == whole


@pytest.mark.skipif(os.name != "posix", reason="kills as POSIX does")
def test_the_command_loses_no_cell_of_a_killed_worker(cluster: Any, tmp_path: Path) -> None:
    config = write(tmp_path, MANY.partition("expect:")[0])
    whole = contents(run(config, tmp_path / "whole").run)
    runs = tmp_path / "runs"
    command = [sys.executable, "-m", "lavender_cli.main", "run", config, "--runs", runs]
    worker = next(iter(cluster.workers.values())).pid
    process = subprocess.Popen(
        [*command, "--dask", cluster.scheduler_address],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    while process.poll() is None and len(list(runs.glob("*/cells/[!.]*"))) < 3:
        time.sleep(0.005)
    os.kill(worker, signal.SIGKILL)
    was_running = process.poll() is None
    said = process.communicate()[1]
    assert process.returncode == 0, said
    assert was_running, "the run ended before its worker was killed"
    # Each log is of one cell, and each cell has one.
    found = Run((runs / "latest").resolve())
    assert len({cell.path for cell in found.cells}) == len(list(found.path.glob("cells/*"))) == 40
    assert contents(found) == whole


def test_workers_of_dask_take_measures_of_a_file_for_a_config_that_extends_another(
    cluster: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from distributed import Client

    (tmp_path / "base.yaml").write_text(MANY)
    folder = tmp_path / "cases"
    folder.mkdir()
    (folder / "measures.py").write_text(OWN_MEASURE)
    config = folder / "tops.yaml"
    config.write_text(EXTENDED)
    whole = run(config, tmp_path / "whole")
    here = Path.cwd()
    monkeypatch.chdir(folder)  # a name that means nothing where the workers were started
    with Client(cluster, set_as_default=False) as client:
        found = run("tops.yaml", tmp_path / "runs", executor=client.get_executor(pure=False))
    monkeypatch.chdir(here)
    assert contents(found.run) == contents(whole.run)
    # A ball of radius 0.1 m is released 0.05 m above the floor: its centre is highest at first.
    tops = [found.run.taken[index]["top"] for index in range(len(found.run.cells))]
    assert tops == pytest.approx([0.15] * 40, abs=1e-12)
    judged = [one.passed for one in found.verdicts if one.name == "it is as high as its start"]
    assert judged == [True] * 40


@pytest.mark.skipif(os.name != "posix", reason="kills as POSIX does")
def test_a_scheduler_of_dask_that_is_restarted_loses_no_cell(tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    scheduler = ("distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", port)
    worker = ("distributed.cli.dask_worker", f"tcp://127.0.0.1:{port}", "--nthreads", 1)
    config, runs = write(tmp_path, MANY), tmp_path / "runs"
    whole = contents(run(config, tmp_path / "whole").run)
    started = [part_of_dask(*scheduler), part_of_dask(*worker)]

    def restart() -> None:
        while len(list(runs.glob("*/cells/[!.]*"))) < 3:
            time.sleep(0.005)
        started[0].kill()
        started[0].wait()
        started.append(part_of_dask(*scheduler))
        started.append(part_of_dask(*worker))  # the first one may have ended

    said: list[str] = []
    restarter = Thread(target=restart, daemon=True)
    restarter.start()
    try:
        with distributed.Client(
            f"tcp://127.0.0.1:{port}", set_as_default=False, timeout="60s"
        ) as client:
            executor = client.get_executor(pure=False)
            found = run(config, runs, progress=Progress(warning=said.append), executor=executor)
        restarter.join()
    finally:
        for process in started:
            process.terminate()
        for process in started:
            process.wait()
    assert "the executor lost its scheduler" in said[0]
    assert contents(found.run) == whole


def test_the_command_uses_the_workers_at_an_address(cluster: Any, tmp_path: Path) -> None:
    drops = write(tmp_path)
    command = [sys.executable, "-m", "lavender_cli.main", "run", drops, "--runs", tmp_path / "runs"]
    done = subprocess.run(
        [*command, "--dask", cluster.scheduler_address], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    found = Run((tmp_path / "runs" / "latest").resolve())
    assert contents(found) == contents(run(drops, tmp_path / "whole").run)


def test_a_scheduler_that_is_not_there_is_said(drops: Path, tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    from lavendersim.runner import dask_cluster

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(dask_cluster, "TIMEOUT", "0.5s")
        refused = pytest.raises(UsageError, match=r"--dask tcp://127\.0\.0\.1:9")
        with refused, dask_cluster.dask_workers("tcp://127.0.0.1:9", 1):
            pass


@pytest.mark.parametrize(
    ("section", "said"),
    [
        ({"queue": "slrum"}, 'queue: expected one of slurm, pbs, lsf, sge, found the text "slrum"'),
        ({"queue": ["slurm"]}, "queue: expected one of slurm, pbs, lsf, sge, found a list of 1"),
        ({"jobs": 3}, "queue: expected one of slurm, pbs, lsf, sge, found nothing"),
        ({"queue": "slurm", "job": 3}, 'unknown key "job"; did you mean "jobs"?'),
        ({"queue": "slurm", "jobs": 0}, "jobs: expected a whole number from 1 on, found 0"),
        ({"queue": "slurm", "jobs": "50"}, 'from 1 on, found the text "50"'),
        ({"queue": "slurm", "jobs": True}, "from 1 on, found true"),
        ("slurm", 'expected queue and jobs, found the text "slurm"'),
    ],
)
def test_what_is_asked_of_a_queue_has_to_be_understood(section: Any, said: str) -> None:
    dask = pytest.importorskip("dask")
    from lavendersim.runner.dask_cluster import dask_workers

    refused = pytest.raises(UsageError)
    with dask.config.set({"lavender": section}), refused as raised, dask_workers(None, 1):
        pass
    assert str(raised.value).startswith("section lavender of Dask's configuration: ")
    assert str(raised.value).endswith(said)


def with_job_queues() -> Any:
    """Return the module of Dask's workers, where dask-jobqueue is there as well."""
    if find_spec("dask_jobqueue") is None:
        pytest.skip("dask-jobqueue is not installed")
    from lavendersim.runner import dask_cluster

    return dask_cluster


def test_ctrl_c_stays_with_who_held_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """As it is imported, dask-jobqueue makes SIGINT a silent exit of the whole process."""
    dask_cluster = with_job_queues()
    for name in [name for name in sys.modules if name.partition(".")[0] == "dask_jobqueue"]:
        monkeypatch.delitem(sys.modules, name)
    held = signal.getsignal(signal.SIGINT)
    assert dask_cluster.job_queues() is sys.modules["dask_jobqueue"]
    assert signal.getsignal(signal.SIGINT) is held


def test_the_jobs_of_slurm_are_what_the_page_on_clusters_says(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """No queue is needed to write a job; none is submitted."""
    dask, dask_cluster = pytest.importorskip("dask"), with_job_queues()
    page = (Path(__file__).parents[3] / "docs" / "clusters.md").read_text()
    text = page.partition("```yaml\nlavender:")[2].partition("```")[0]
    asked = yaml.safe_load("lavender:" + text)
    scaled: list[int] = []

    def scale(self: Any, workers: int = 0, *, jobs: int = 0) -> None:
        scaled.append(jobs)

    monkeypatch.setattr(dask_cluster.job_queues().SLURMCluster, "scale", scale)
    # As from a file: dask-jobqueue's own defaults are under it.
    with dask.config.set(dask.config.merge({"jobqueue": dask.config.get("jobqueue")}, asked)):
        assert dask_cluster.asked_of_queue() == ("slurm", 50)
        cluster = dask_cluster._cluster(1)
        try:
            script = cluster.job_script()
        finally:
            cluster.close()
    assert 50 in scaled  # of jobs; dask itself scales to none at the end
    lines = script.splitlines()
    assert lines[0] == "#!/usr/bin/env bash"
    # One core and 2 GB a job, two hours at most: dask-jobqueue writes memory in whole units.
    assert {"#SBATCH --cpus-per-task=1", "#SBATCH -t 02:00:00"} <= {*lines}
    assert any(line.startswith("#SBATCH --mem=") for line in lines)
    (worker,) = [line for line in lines if "distributed.cli.dask_worker" in line]
    assert sys.executable in worker
    assert "--nthreads 1" in worker
    assert "tcp://" in worker


def test_a_queue_without_its_limits_is_refused_in_a_sentence() -> None:
    dask, dask_workers = pytest.importorskip("dask"), with_job_queues().dask_workers
    refused = pytest.raises(UsageError, match=r"cores and memory|specify how many cores")
    with dask.config.set({"lavender": {"queue": "slurm"}}), refused, dask_workers(None, 1):
        pass


def test_an_experiment_is_run_by_dask_of_this_machine(drops: Path, tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    from lavendersim.runner.dask_cluster import dask_workers

    with dask_workers(None, 1) as workers:
        found = run(load_experiment(drops), tmp_path / "runs", executor=workers)
    assert contents(found.run) == contents(run(drops, tmp_path / "whole").run)
