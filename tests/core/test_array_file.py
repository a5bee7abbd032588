"""Arrays in files: what goes in comes out, and whatever is wrong has a name."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as st_numpy

from hrcplan.core.array_file import Arrays, Format, array, map_file
from hrcplan.errors import InputError

TOYS = Format(b"TOYSTOYS", 3, "toy", "box of toys", "buy one")
KINDS = ("<u8", "<i8", "<i4", "<f4", "|b1")
ARRAYS = st.lists(
    st.sampled_from(KINDS).flatmap(
        lambda kind: st_numpy.arrays(np.dtype(kind), st_numpy.array_shapes(min_dims=1, min_side=0))
    )
)


@given(ARRAYS)
def test_what_goes_in_comes_out(given_arrays: list[np.ndarray]) -> None:
    arrays = Arrays()
    entries = [arrays.add(one, one.dtype.str) for one in given_arrays]
    header, body = TOYS.decode(TOYS.encode({"all": entries}, arrays), "file")
    for entry, one in zip(header["all"], given_arrays, strict=True):
        found = array(body, entry, one.dtype.str)
        assert found.shape == one.shape
        assert found.tobytes() == one.tobytes()


def test_every_flipped_byte_and_every_cut_is_noticed() -> None:
    arrays = Arrays()
    entry = arrays.add(np.arange(5), "<i4")
    data = TOYS.encode({"numbers": entry}, arrays)
    codes = {"not-a-toy", "toy-version", "toy-truncated", "toy-damaged"}
    met = set()
    for place in range(len(data)):
        flipped = data[:place] + bytes([data[place] ^ 1]) + data[place + 1 :]
        for spoiled in (flipped, data[:place]):
            with pytest.raises(InputError) as caught:
                TOYS.decode(spoiled, "file")
            met.add(caught.value.code)
    assert met == codes
    assert caught.value.hint == "buy one"
    newer = Format(TOYS.magic, 4, "toy", "", "").encode({}, Arrays())
    with pytest.raises(InputError, match="format 4; this hrcplan reads 3"):
        TOYS.decode(newer, "file")
    assert struct.unpack_from("<I", newer, 8) == (4,)


def test_files_are_mapped_and_arrays_of_them_are_read_only(tmp_path: Path) -> None:
    arrays = Arrays()
    entry = arrays.add(np.arange(5), "<i4")
    (tmp_path / "file").write_bytes(TOYS.encode({}, arrays))
    found = array(TOYS.decode(map_file(tmp_path / "file"), "file")[1], entry, "<i4")
    assert found.tolist() == [0, 1, 2, 3, 4]
    assert not found.flags.writeable
    (tmp_path / "empty").touch()
    assert map_file(tmp_path / "empty") == b""
    with pytest.raises(FileNotFoundError):
        map_file(tmp_path / "missing")
