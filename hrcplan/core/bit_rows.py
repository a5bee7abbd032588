"""Bit matrices: rows of 64-bit words that are transposed, combined and drawn from all at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from hrcplan.core.arrays import Bools, Ids, Words

WORD = 64
_ONES = np.uint64(2**WORD - 1)
_WORDS = 1 << 20  # words of numbers that are looked at together: 8 MB
# Each stage swaps the off-diagonal blocks of all 8 x 8 bit blocks; a block is one word.
_SWAPS = (
    (np.uint64(7), np.uint64(0x00AA00AA00AA00AA)),
    (np.uint64(14), np.uint64(0x0000CCCC0000CCCC)),
    (np.uint64(28), np.uint64(0x00000000F0F0F0F0)),
)


def n_words(n_bits: int) -> int:
    """Return how many words hold a number of bits; at least one."""
    return max(1, -(-n_bits // WORD))


def pack(numbers: Sequence[int], n_bits: int) -> Words:
    """Return integers of ``n_bits`` bits as rows of words, the lowest word first.

    >>> pack([1, 2**64], 65)
    array([[1, 0],
           [0, 1]], dtype=uint64)
    """
    size = 8 * n_words(n_bits)
    raw = b"".join(number.to_bytes(size, "little") for number in numbers)
    return np.frombuffer(raw, np.uint64).reshape(len(numbers), size // 8).copy()


def unpack(rows: Words) -> list[int]:
    """Return rows of words as integers.

    >>> unpack(pack([1, 2**64], 65)) == [1, 2**64]
    True
    """
    raw, size = rows.tobytes(), rows.shape[1] * rows.itemsize
    return [int.from_bytes(raw[i : i + size], "little") for i in range(0, len(raw), size)]


def transpose(rows: Words) -> Words:
    """Return the transpose of a bit matrix; row ``i`` holds bit ``i`` of all rows.

    The number of rows is filled up with zeros to whole words.

    >>> unpack(transpose(pack([0b11, 0b10], 2)))[:2]
    [1, 3]
    """
    count, width = n_words(len(rows)) * WORD, rows.shape[1] * 8
    padded = np.zeros((count, width), np.uint8)
    padded[: len(rows)] = np.ascontiguousarray(rows).view(np.uint8)
    blocks = padded.reshape(count // 8, 8, width).transpose(2, 0, 1).copy().view(np.uint64)
    for shift, mask in _SWAPS:
        swap = blocks >> shift
        swap ^= blocks
        swap &= mask
        blocks ^= swap
        swap <<= shift
        blocks ^= swap
    bits = blocks.view(np.uint8).reshape(width, count // 8, 8).transpose(0, 2, 1)
    return np.ascontiguousarray(bits).reshape(width * 8, count // 8).view(np.uint64)


def bools(rows: Words, n_bits: int) -> Bools:
    """Return the first bits of rows as a matrix of truth values."""
    flat = np.ascontiguousarray(rows).view(np.uint8)
    return np.unpackbits(flat, axis=1, count=n_bits, bitorder="little").view(np.bool_)


def of_bools(matrix: Bools) -> Words:
    """Return a matrix of truth values as rows of words.

    >>> unpack(of_bools(np.array([[True, False], [False, True]])))
    [1, 2]
    """
    rows = np.zeros((len(matrix), 8 * n_words(matrix.shape[1])), dtype=np.uint8)
    bits = np.packbits(matrix, axis=1, bitorder="little")
    rows[:, : bits.shape[1]] = bits
    return rows.view(np.uint64)


def draw_bits(rows: Words, rng: np.random.Generator) -> Ids:
    """Return the position of one bit of each row, drawn uniformly from those set; -1 if none is."""
    ends = np.cumsum(np.bitwise_count(rows), axis=1, dtype=np.int64)
    totals = ends[:, -1]
    ranks = (rng.random(len(rows)) * totals).astype(np.int64)
    words = np.minimum((ends <= ranks[:, None]).sum(axis=1), rows.shape[1] - 1)
    each = np.arange(len(rows))
    word = rows[each, words]
    ranks -= ends[each, words] - np.bitwise_count(word)
    places = words * WORD
    for width in (32, 16, 8, 4, 2, 1):
        lower = np.bitwise_count(word & np.uint64((1 << width) - 1))
        is_above = ranks >= lower
        ranks -= lower * is_above
        word = word >> (is_above * np.uint64(width))
        places += is_above * width
    return np.where(totals > 0, places, -1)


@dataclass(frozen=True, eq=False)
class Ragged:
    """Lists of different lengths, end to end."""

    starts: Ids
    sizes: Ids

    @classmethod
    def of_sizes(cls, sizes: Ids) -> Ragged:
        """Return lists of the given lengths."""
        return cls(np.cumsum(sizes) - sizes, sizes)

    def expand(self, ids: Ids) -> tuple[Ids, Ids]:
        """Return all entries of the lists ``ids``: the index into ``ids``, and the entry."""
        sizes = self.sizes[ids]
        ends = np.cumsum(sizes)
        owners = np.repeat(np.arange(len(ids)), sizes)
        entries = np.arange(len(owners)) + np.repeat(self.starts[ids] - (ends - sizes), sizes)
        return owners, entries


@dataclass(frozen=True, eq=False)
class SparseRows:
    """Rows of a bit matrix by the words that are not 0, row after row.

    Attributes:
        lists: Which entries belong to a row.
        places: The index of each word in its row.
        words: The words.
    """

    lists: Ragged
    places: Ids
    words: Words

    @classmethod
    def of(cls, numbers: Sequence[int]) -> SparseRows:
        """Return integers, few bits of which are set, as sparse rows."""
        owners, bits = bit_positions(numbers)
        places = bits // WORD
        is_first = np.ones(len(bits), dtype=np.bool_)
        is_first[1:] = (owners[1:] != owners[:-1]) | (places[1:] != places[:-1])
        starts = np.flatnonzero(is_first)
        single = np.uint64(1) << (bits % WORD).astype(np.uint64)
        words = np.bitwise_or.reduceat(single, starts) if len(starts) else single
        sizes = np.bincount(owners[starts], minlength=len(numbers))
        return cls(Ragged.of_sizes(sizes), places[starts], words)


def bit_positions(numbers: Sequence[int]) -> tuple[Ids, Ids]:
    """Return the bits of integers that are set: whose they are, in order, and their positions.

    >>> bit_positions([0b101, 0, 0b10])
    (array([0, 0, 2]), array([0, 2, 1]))
    """
    owners, places = [np.zeros(0, np.int64)], [np.zeros(0, np.int64)]
    longest = max((number.bit_length() for number in numbers), default=0)
    chunk = max(1, _WORDS // n_words(longest))
    for begin in range(0, len(numbers), chunk):
        rows = pack(numbers[begin : begin + chunk], longest)
        flat = rows.reshape(-1)
        at = np.flatnonzero(flat != 0)
        which, columns = np.divmod(at, rows.shape[1])
        entries, bits = np.nonzero(bools(flat[at][:, None], WORD))
        owners.append(which[entries] + begin)
        places.append(columns[entries] * WORD + bits)
    return np.concatenate(owners), np.concatenate(places)


class RowSets:
    """Sets of rows; ``combine`` says of each the conjunction or disjunction of its rows.

    Args:
        owners: The set of each member.
        members: The index of a row, for each member.
        n_sets: How many sets there are.
    """

    def __init__(self, owners: Ids, members: Ids, n_sets: int) -> None:
        members = members[np.argsort(owners, kind="stable")]
        lists = Ragged.of_sizes(np.bincount(owners, minlength=n_sets))
        order = np.argsort(-lists.sizes, kind="stable")
        starts, sizes = lists.starts[order], lists.sizes[order]
        # The k-th members of all sets that have so many; the sets are in order of size.
        n_ranks = int(sizes[0]) if n_sets else 0
        self._ranks = [members[starts[sizes > k] + k] for k in range(n_ranks)]
        self._places = np.argsort(order)

    def combine(self, rows: Words, how: Literal["all", "any"]) -> Words:
        """Return one row per set; no rows at all are true with ``all``, and false with ``any``."""
        unit, operation = (_ONES, np.bitwise_and) if how == "all" else (0, np.bitwise_or)
        combined = np.full((len(self._places), rows.shape[1]), unit, dtype=np.uint64)
        for members in self._ranks:
            part = combined[: len(members)]
            operation(part, rows[members], out=part)
        return combined[self._places]
