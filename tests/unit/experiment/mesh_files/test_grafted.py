"""`file: part.stl` is as if its triangles stood in the config: equal cells, places, and limits."""

from __future__ import annotations

import random
from pathlib import Path

import pytest
from cube_files import FILES, IN_YAML, PLACES

from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment, load_experiment_text
from lavendersim.experiment.mesh_files import grafted
from tests.marked_config import marked_places

CONFIG = """\
scene:
  bodies:
    part: {{shape: {{kind: mesh, {mesh}}}, position: [0, 0, 0]}}
    ball: {{shape: {{kind: sphere, radius: 0.1}}, mass: 1, position: [0, 0, 2]}}
duration: 0.1
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder of a project with the files of a cube."""
    (tmp_path / "pyproject.toml").touch()
    below = tmp_path / "below"
    below.mkdir()
    for name, raw in FILES.items():
        (below / name).write_bytes(raw)
    return below


def config(folder: Path, mesh: str, name: str = "it.yaml") -> Path:
    (folder / name).write_text(CONFIG.format(mesh=mesh))
    return folder / name


def refusals(path: Path) -> list[str]:
    with pytest.raises(ConfigError) as refused:
        load_experiment(path)
    return [str(defect).replace(f"{path.parent}/", "") for defect in refused.value.defects]


def digest(path: Path) -> str:
    (cell,) = load_experiment(path).cells()
    return cell.digest


def test_every_form_of_a_cube_is_the_same_cell(folder: Path) -> None:
    as_written = digest(config(folder, IN_YAML))
    assert [digest(config(folder, f"file: {name}")) for name in FILES] == [as_written] * 3


def test_what_is_kept_of_a_run_does_not_look_at_the_file(folder: Path) -> None:
    experiment = load_experiment(config(folder, "file: binary.STL, scale: 1/8"))
    (cell,) = experiment.cells()
    (folder / "binary.STL").unlink()
    (again,) = load_experiment_text(experiment.text, "config.yaml").cells()
    assert again.digest == cell.digest
    # 1/8 is a power of two: products are exact.
    assert cell.config.scene.bodies["part"].shape.vertices == tuple(
        (x / 8, y / 8, z / 8) for x, y, z in PLACES
    )
    assert experiment.text.startswith("# it.yaml, with the triangles of binary.STL.\n")


def test_a_shape_with_a_name_and_a_parent_of_the_config_may_have_a_file(folder: Path) -> None:
    (folder.parent / "base.yaml").write_text(
        CONFIG.format(mesh="").replace("{kind: mesh, }", "cube") + "numerics: {timestep: 1/480}\n"
    )
    shapes = "scene: {shapes: {cube: {kind: mesh, file: below/cube.obj}}}"
    (folder.parent / "middle.yaml").write_text(f"extends: base.yaml\n{shapes}\n")
    child = folder / "child.yaml"
    child.write_text("extends: ../middle.yaml\nduration: 0.2\n")
    (cell,) = load_experiment(child).cells()
    assert len(cell.config.scene.bodies["part"].shape.triangles) == 12


@pytest.mark.parametrize(
    ("mesh", "sentence"),
    [
        ("file: §a.ply", 'expected the path of a file *.obj or *.stl, found the text "a.ply"'),
        ("file: §7", "expected the path of a file *.obj or *.stl, found 7"),
        ("file: §gone.stl", "gone.stl: no such file or directory"),
        ("file: §/etc/part.stl", 'expected a path from this file\'s folder, found "/etc/part.stl"'),
        ("file: §../../part.stl", '"../../part.stl" is outside of {project}'),
        ("file: §empty.obj", "empty.obj has no triangles"),
        ("file: §cut.stl", "cut.stl: 12 facets, declared at byte 80, are 684 bytes; found 600"),
        ("file: §huge.stl", "huge.stl has 8388609 bytes; expected at most 8388608"),
    ],
)  # fmt: skip
def test_a_file_that_is_refused_is_named_where_the_config_names_it(
    folder: Path, mesh: str, sentence: str
) -> None:
    (folder / "empty.obj").write_bytes(b"# nothing\n")
    (folder / "cut.stl").write_bytes(b"?" + FILES["binary.STL"][1:600])
    (folder / "huge.stl").write_bytes(b"")
    with (folder / "huge.stl").open("r+b") as sparse:
        sparse.truncate(grafted.LARGEST + 1)
    text, (place,) = marked_places(CONFIG.format(mesh=mesh))
    (folder / "it.yaml").write_text(text)
    said = sentence.replace("{project}", str(folder.parent.resolve()))
    assert refusals(folder / "it.yaml") == [f"it.yaml:{place}: file: {said}"]


def test_the_line_of_a_file_is_named(folder: Path) -> None:
    (folder / "bad.obj").write_bytes(b"v 0 0 0\nv 1 0 0\nv 0 1 O\nf 1 2 3\n")
    path = config(folder, "file: bad.obj")
    assert refusals(path) == ['bad.obj:3:1: expected a number, found "O"']
    (folder / "bad.obj").write_bytes(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\n")
    assert refusals(path) == ["bad.obj:6:1: triangle 1: its corners lie on a line"]
    (folder / "bad.obj").write_bytes(b"v 0 0 0\nv 1 0 0\nv 0 1e60 0\nf 1 2 3\n")
    (said,) = refusals(path)
    assert said.startswith("bad.obj:3:1: vertices[2][1]: expected a number from -1e+50 to 1e+50")


def test_both_a_file_and_vertices_are_refused(folder: Path) -> None:
    text, (place,) = marked_places(CONFIG.format(mesh=f"file: cube.obj, §{IN_YAML}"))
    (folder / "it.yaml").write_text(text)
    said = f'it.yaml:{place}: vertices: "cube.obj" has them; keep one'
    assert refusals(folder / "it.yaml") == [said]


@pytest.mark.parametrize(
    ("parent", "child"), [(IN_YAML, "file: cube.obj"), ("file: gone.stl", IN_YAML)]
)
def test_a_file_replaces_the_triangles_of_a_parent_and_they_a_file(
    folder: Path, parent: str, child: str
) -> None:
    config(folder, f"scale: 2, {parent}", "base.yaml")
    shape = f"scene: {{bodies: {{part: {{shape: {{{child}}}}}}}}}"
    (folder / "child.yaml").write_text(f"extends: base.yaml\n{shape}\n")
    assert digest(folder / "child.yaml") == digest(config(folder, f"scale: 2, {IN_YAML}"))


def test_a_file_that_a_text_or_an_option_names_is_refused_at_its_place(folder: Path) -> None:
    text, (place,) = marked_places(CONFIG.format(mesh="file: §cube.obj"))
    with pytest.raises(ConfigError) as refused:
        load_experiment_text(text, "config.yaml")
    assert str(refused.value) == (
        f"config.yaml:{place}: file: a config given as text has no folder to look in; expected "
        "vertices and triangles, or a config that is a file"
    )
    named = "set scene.bodies.part.shape.file="
    for mesh in ("file: cube.obj", IN_YAML):
        with pytest.raises(ConfigError) as refused:
            load_experiment(config(folder, mesh), overrides=[f"{named}text.stl"])
        assert str(refused.value) == (
            f"--{named}text.stl:1:{len(named) + 3}: file: an option has no folder to look in; "
            "expected the name of a mesh of scene.shapes as `shape`"
        )


def test_a_file_in_a_sweep_is_refused(folder: Path) -> None:
    path = config(folder, "file: cube.obj")
    named = "part: {path: scene.bodies.part.shape.file, values: [text.stl]}"
    with path.open("a") as text:
        text.write(f"sweep: {{{named}}}\n")
    (said,) = refusals(path)
    assert "file: expected it as the key of a mesh" in said


def test_a_scale_that_leads_too_far_is_refused(folder: Path) -> None:
    (said,) = refusals(config(folder, "file: cube.obj, scale: 3e50"))
    assert said.endswith("scale: expected vertices within 1e+50 [m]")


def test_more_than_a_config_holds_is_refused_before_it_is_kept(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("lavendersim.experiment.mesh_files.triangles.MOST_OF_BOTH", 10)
    monkeypatch.setattr("lavendersim.experiment.mesh_files.stl.MOST_OF_BOTH", 10)
    sentence = "expected at most 10 vertices and triangles together, found more"
    expected = [
        f"cube.obj:11:1: {sentence}",  # eight vertices, then the third triangle
        # A face has four vertices of its own in its first two facets: 4 + 2, 3 + 1, and then the
        # fourth facet, of seven lines each, has one too many.
        f"text.stl:23:1: {sentence}",
        f"it.yaml:3:38: file: binary.STL: {sentence}",
    ]
    for name, one in zip(FILES, expected, strict=True):
        assert refusals(config(folder, f"file: {name}")) == [one]


@pytest.mark.parametrize("name", FILES)
def test_flipped_bytes_and_cuts_are_read_or_refused(folder: Path, name: str) -> None:
    path, draw = config(folder, f"file: {name}"), random.Random(20261128)
    whole, refused = FILES[name], 0
    for _ in range(200):
        raw = bytearray(whole)
        for _ in range(draw.choice((1, 1, 2, 8))):
            any_byte, digit = draw.randrange(256), draw.choice(b"0123456789")
            raw[draw.randrange(len(raw))] = draw.choice((any_byte, digit))
        if draw.random() < 0.25:
            del raw[draw.randrange(len(raw)) :]
        (folder / name).write_bytes(bytes(raw))
        said = ""
        try:
            load_experiment(path)
        except ConfigError as error:
            refused, said = refused + 1, str(error)
        assert len(said.splitlines()) <= 20
        assert all(len(line) < 400 for line in said.splitlines())
    assert 50 < refused < 200
