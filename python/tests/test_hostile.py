"""Whatever is passed, a crashrank.Error comes back or an answer: the interpreter never ends."""

import os

import crashrank
import numpy as np
from conftest import DATA, box, box_arrays
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

EXAMPLES = int(os.environ.get("CRASHRANK_PYTHON_EXAMPLES", "150"))
VERTICES, FACES = box_arrays()
CUBE = box()
TIMES = np.linspace(0, 3, 4)
RANKER = crashrank.Ranker(DATA / "scenarios/oncoming_truck.json", max_candidates=16)
SCENARIO = (DATA / "scenarios/oncoming_truck.json").read_text()

DTYPES = st.one_of(
    hnp.floating_dtypes(),
    hnp.integer_dtypes(),
    hnp.unsigned_integer_dtypes(),
    hnp.complex_number_dtypes(),
    hnp.boolean_dtypes(),
    hnp.byte_string_dtypes(max_len=8),
    hnp.datetime64_dtypes(),
    st.just(np.dtype(object)),
    st.just(np.dtype([("a", "f4"), ("b", "i4")])),
)
SHAPES = st.one_of(
    hnp.array_shapes(min_dims=0, max_dims=4, min_side=0, max_side=5),
    st.sampled_from([(3,), (4, 4), (0, 4, 4), (2, 4, 4), (5, 3), (0, 3), (2, 4, 3), (2, 2)]),
)


@st.composite
def arrays(draw):
    """Draw an array and look at it from odd angles: strides, order, flags, lost owners."""
    shape = draw(SHAPES)
    dtype = draw(DTYPES)
    try:
        array = draw(hnp.arrays(dtype, shape, fill=st.nothing()))
    except Exception:  # some types have no values to draw
        array = np.zeros(shape, dtype=dtype)
    for _ in range(draw(st.integers(0, 3))):
        change = draw(st.integers(0, 6))
        if change == 0 and array.ndim:
            array = array[::-1]
        elif change == 1:
            array = array.T
        elif change == 2:
            array = np.asfortranarray(array)
        elif change == 3:
            array = array.view()
            array.setflags(write=False)
        elif change == 4 and array.ndim and array.shape[-1]:
            array = np.repeat(array, 2, axis=-1)[..., ::2]
        elif change == 5 and not array.dtype.hasobject and array.size:
            array = np.frombuffer(bytearray(array.tobytes()), dtype=array.dtype).reshape(
                array.shape
            )
        elif change == 6 and array.ndim and array.shape[0]:
            array = np.broadcast_to(array[:1], (3, *array.shape[1:]))
    return array


NEAR_POSES = st.builds(
    crashrank.pose_matrix,
    *[st.floats(-3, 3) for _ in range(3)],
    *[st.floats(-360, 360) for _ in range(3)],
)
ANY = st.one_of(
    arrays(),
    NEAR_POSES,
    st.just(VERTICES),
    st.just(FACES),
    st.none(),
    st.text(max_size=8),
    st.binary(max_size=8),
    st.floats(),
    st.integers(-(2**70), 2**70),
    st.complex_numbers(),
    st.lists(st.one_of(st.floats(), st.integers(), st.text(max_size=3)), max_size=5),
    st.dictionaries(st.text(max_size=4), st.integers(), max_size=3),
    st.builds(object),
    st.just(CUBE),
    st.just(np.float32),
)
CALLS = {
    "Model": lambda a, b, c: crashrank.Model(a, b, c),
    "Model of vertices": lambda a, b, _: crashrank.Model(VERTICES, a, b),
    "Model of faces": lambda a, b, _: crashrank.Model(a, FACES, b),
    "collide": lambda a, b, c: crashrank.collide(a, b, c),
    "collide at": lambda a, *_: crashrank.collide(CUBE, CUBE, a),
    "collide_any": lambda a, b, _: crashrank.collide_any(CUBE, CUBE, a, workers=b),
    "collide_any at": lambda a, *_: crashrank.collide_any(CUBE, CUBE, a),
    "collide_all at": lambda a, *_: crashrank.collide_all(CUBE, CUBE, a, workers=2),
    "pairs_hash": lambda a, *_: crashrank.pairs_hash(a),
    "pose_matrix": lambda a, b, c: crashrank.pose_matrix(a, b, c, a, b, c),
    "load_model": lambda a, b, c: crashrank.load_model(a, scale=b, up=c),
    "save": lambda a, b, c: CUBE.save(f"/nonexistent/{a}", overwrite=b, mass_kg=c),
    "rank": lambda a, b, c: crashrank.rank(a, measure=b, workers=c),
    "Scenario": lambda a, b, _: crashrank.Scenario(a, models=b),
    "update": lambda a, b, c: RANKER.update(ego=a, actors=b, times_s=c),
    "update of the lorry": lambda a, b, _: RANKER.update(actors={"lorry": a}, times_s=b),
    "update of odds": lambda a, *_: RANKER.update(probabilities={"lorry": a}),
    "candidates": lambda a, b, c: RANKER.rank(a, times_s=b, names=c, deadline_s=0.01),
    "candidates at": lambda a, *_: RANKER.rank(a, times_s=TIMES, deadline_s=0.01),
    "deadline": lambda a, b, _: RANKER.rank(deadline_s=a, work_budget=b, first_place_only=True),
}


@settings(
    max_examples=EXAMPLES, deadline=None, suppress_health_check=list(HealthCheck), database=None
)
@given(name=st.sampled_from(sorted(CALLS)), a=ANY, b=ANY, c=ANY)
def test_any_arguments(name, a, b, c):
    try:
        CALLS[name](a, b, c)
    except crashrank.Error as error:
        assert error.code != "internal", error
        assert error.reason
        assert error.remedy


JSON = st.recursive(
    st.one_of(st.none(), st.booleans(), st.floats(), st.integers(), st.text(max_size=6)),
    lambda inner: st.one_of(
        st.lists(inner, max_size=3), st.dictionaries(st.text(max_size=6), inner, max_size=3)
    ),
    max_leaves=6,
)


@settings(
    max_examples=EXAMPLES, deadline=None, suppress_health_check=list(HealthCheck), database=None
)
@given(data=st.data())
def test_scenarios_with_a_part_replaced(data):
    import json

    document = json.loads(SCENARIO)
    at = document
    while True:
        key = data.draw(st.sampled_from(sorted(at) if isinstance(at, dict) else range(len(at))))
        inner = at[key]
        if not isinstance(inner, (dict, list)) or not inner or data.draw(st.booleans()):
            break
        at = inner
    at[key] = data.draw(JSON)
    try:
        crashrank.Scenario(document, base=DATA / "scenarios")
    except crashrank.Error as error:
        assert error.code in ("bad_input", "limit_exceeded", "usage", "not_found")
