"""Motions of logs: lavender's, and those that another program wrote with the least it can."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hand_made_log import CONFIG, write_log

from lavendersim.errors import ConfigError, TraceError, UsageError
from lavendersim.laws.judging import judge_laws
from lavendersim.laws.motion import changed, pairs_of_states, read_motion

STILL = (0.0, 0.0, 0.0)
STEP = 10_000_000  # [ns]
REST = [(k * STEP, (0.0, 0.0, 0.1), STILL, STILL) for k in range(3)]


def test_a_log_of_the_mcap_library_alone_is_read(tmp_path: Path) -> None:
    motion = read_motion(write_log(tmp_path / "mine.mcap", REST))
    assert motion.bodies == ("floor", "ball")  # what does not move may be absent
    assert motion.steps.tolist() == [0, 1, 2]
    assert motion.pose[1].tolist() == [[0, 0, 0, 1, 0, 0, 0], [0, 0, 0.1, 1, 0, 0, 0]]
    assert pairs_of_states(motion) == [1, 2]


def test_it_is_judged(tmp_path: Path) -> None:
    """At rest no law is broken; 0.3 m/s more in the third state are 0.6 N s beyond the cone."""
    assert judge_laws(read_motion(write_log(tmp_path / "rest.mcap", REST))).named is None
    pushed = [*REST[:2], (2 * STEP, (0.003, 0.0, 0.1), (0.3, 0.0, 0.0), STILL)]
    judged = judge_laws(read_motion(write_log(tmp_path / "pushed.mcap", pushed)))
    assert judged.named is not None
    assert judged.named.step == 2
    assert judged.named.bodies == ("ball",)
    # 2 kg by 0.3 m/s without a spin: a push through the centre, of which friction gives next to
    # nothing: at most mu m g dt = 0.1 N s.
    momenta = sum(judged.numbers[law][1] for law in ("momentum", "cone"))
    assert 0.5 < momenta < 0.85


def test_times_may_be_rounded_to_a_microsecond(tmp_path: Path) -> None:
    rounded = [(time + 400, *rest) for time, *rest in REST]
    assert read_motion(write_log(tmp_path / "a.mcap", rounded)).steps.tolist() == [0, 1, 2]


@pytest.mark.parametrize(
    ("states", "options", "expected"),
    [
        (REST, {"config": None}, "expected an attachment resolved.json or config.yaml, found none"),
        (REST, {"body": "bal"}, '/tf has "bal", and no body of the config is called so'),
        (REST, {"body": "floor"}, 'no message of /tf has the body "ball", which moves'),
        (REST, {"schema": "my.Speeds"}, "expected the schema lavender.Velocities, found my.Speeds"),
        ([], {}, "this log has no message of /tf"),
        ([(3_000_000, *REST[0][1:])], {}, "log_time 3000000 ns is the end of no step"),
        ([(0, (float("nan"), 0, 0), STILL, STILL)], {}, 'no finite pose and velocity of "ball"'),
    ],
)
def test_what_a_log_lacks_is_said_in_a_sentence(
    tmp_path: Path, states: list[tuple[int, ...]], options: dict[str, str], expected: str
) -> None:
    path = write_log(tmp_path / "lacks.mcap", states, **options)  # type: ignore[arg-type]
    with pytest.raises(TraceError, match=r"lacks\.mcap: ") as raised:
        read_motion(path)
    assert expected in str(raised.value)


def test_a_config_that_is_wrong_says_where(tmp_path: Path) -> None:
    wrong = CONFIG.replace("mass: 2", "mas: 2")
    with pytest.raises(ConfigError, match=r"config\.yaml:7"):
        read_motion(write_log(tmp_path / "wrong.mcap", REST, config=wrong))


def test_a_file_that_is_none_or_cut_is_damaged(tmp_path: Path) -> None:
    with pytest.raises(TraceError, match="no such log"):
        read_motion(tmp_path / "none.mcap")
    path = write_log(tmp_path / "cut.mcap", REST)
    path.write_bytes(path.read_bytes()[:300])
    with pytest.raises(TraceError, match="damaged"):
        read_motion(path)


def test_states_that_are_no_step_apart_are_refused(tmp_path: Path) -> None:
    motion = read_motion(write_log(tmp_path / "apart.mcap", [REST[0], REST[2]]))
    with pytest.raises(UsageError, match="no two states that are one step apart"):
        pairs_of_states(motion)


def test_steps_that_an_event_opens_are_known(tmp_path: Path) -> None:
    """A new velocity at 0.01 s acts before step 2, which begins there."""
    events = "events:\n  - {at: 0.01, body: ball, velocity: [1, 0, 0]}\n"
    motion = read_motion(write_log(tmp_path / "e.mcap", REST, config=CONFIG + events))
    assert changed(motion) == {2: {"ball"}}
    judged = judge_laws(motion)
    assert (judged.steps.tolist(), judged.left_out) == ([1], 1)
    assert np.isfinite(judged.numbers["momentum"]).all()
