"""What speaks for a cut between two slices: one row of scale-free numbers per cut."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.parts.coverage import Coverage
from services.primitive_recovery.parts.profile import SLICES, Profile
from services.primitive_recovery.parts.view import PartView
from shared.jit import kernel

Array = NDArray[np.float64]

MARGIN = 3
"""Slices at either end that are no part of their own."""

CUTS = np.arange(MARGIN, SLICES - MARGIN + 1)
"""Cut k lies between slice k - 1 and slice k."""

_WINDOWS = np.array([[0, 1], [1, 3], [3, 6], [6, 12], [12, 24], [0, SLICES]])
"""Slices away from the cut, nearest and farthest; the last one is the whole side."""

_LENGTHS = [0, 2, 3, 4, 5, 6]
"""Channels of lengths; the other one is a share."""

_LINE = np.arange(SLICES) - (SLICES - 1) / 2
_LINE_SQUARED = _LINE @ _LINE

_PAD = 24
_LEAST_WIDTH = 0.02


def slice_features(profile: Profile, view: PartView, covered: Coverage) -> Array:
    """Return features (2, CUTS, F) of all cuts, and the same seen from the other end.

    Over windows that double in reach to either side of a cut: widths and
    their ratios, how much of them is filled, how the two sides are offset
    across and in depth, relief, heights. Then what share of the object the cut
    leaves, how much background either side would cover, and what the object
    is like as a whole. Lengths are in units of `Profile.size`.

    Parameters
    ----------
    profile : Profile
        Of the object along one of its axes.
    view : PartView
        Of the object.
    covered : Coverage
        Of the profile's widths.
    """
    size = profile.size
    channels = np.array(
        [
            profile.width,
            profile.filled,
            _straightened(profile.middle),
            _straightened(profile.depth),
            profile.relief,
            profile.top,
            profile.bottom,
        ]
    )
    channels[_LENGTHS] /= size
    up = view.up
    everywhere = np.array(
        [
            profile.length / size,
            covered.whole,
            profile.filled.mean(),
            abs(profile.axis @ view.ray),
            0.0 if up is None else 1.0,
            0.0 if up is None else abs(profile.axis @ up),
            (profile.middle.max() - profile.middle.min()) / size,
            profile.top.max() / size,
            channels[0].max(),
            channels[0].min(),
            float(view.is_piece),
        ]
    )
    return rows_both_ways(channels, covered.lower, covered.upper, everywhere, _WINDOWS, MARGIN)


@kernel
def rows_both_ways(
    channels: Array,
    lower: Array,
    upper: Array,
    everywhere: Array,
    windows: NDArray[np.int64],
    margin: int,
) -> Array:
    """Return a row per cut (2, CUTS, F), as `slice_rows`, and the same seen from the other end."""
    ahead = slice_rows(channels, lower, upper, everywhere, windows, margin)
    back = slice_rows(
        channels[:, ::-1].copy(),
        upper[::-1].copy(),
        lower[::-1].copy(),
        everywhere,
        windows,
        margin,
    )
    rows = np.empty((2, *ahead.shape))
    rows[0] = ahead
    rows[1] = back[::-1]
    return rows


@kernel
def slice_rows(
    channels: Array,
    lower: Array,
    upper: Array,
    everywhere: Array,
    windows: NDArray[np.int64],
    margin: int,
) -> Array:
    """Return a row per cut (CUTS, F).

    Parameters
    ----------
    channels : (7, S) array
        Width, filled share, middle, depth, relief, top, bottom of every slice.
    lower, upper : (S + 1,) array
        Background covered by the slices before, and from, each cut.
    everywhere : (E,) array
        What is the same for all cuts; its second is the whole's covered background.
    windows : (W, 2) array
        Nearest and farthest slice from the cut.
    margin : int
        First cut.
    """
    slices = channels.shape[1]
    wide = len(windows)
    cuts = slices - 2 * margin + 1
    rows = np.zeros((cuts, 3 * wide + (2 * wide - 1) + 2 * wide + 6 * wide + 7 + len(everywhere)))
    low, high = np.zeros(wide), np.zeros(wide)
    area = channels[0].sum()
    column = 0
    for channel in range(7):
        values = channels[channel]
        total = np.zeros(slices + 2 * _PAD + 1)
        for k in range(slices + 2 * _PAD):
            inner = min(max(k - _PAD, 0), slices - 1)
            outside = channel == 0 and inner != k - _PAD
            total[k + 1] = total[k] + (0.0 if outside else values[inner])
        for row in range(cuts):
            cut = row + margin
            at = cut + _PAD
            for w in range(wide):
                near, far = windows[w]
                if far >= slices:
                    low[w] = (total[at] - total[_PAD]) / cut
                    high[w] = (total[_PAD + slices] - total[at]) / (slices - cut)
                else:
                    low[w] = (total[at - near] - total[at - far]) / (far - near)
                    high[w] = (total[at + far] - total[at + near]) / (far - near)
            place = column
            for w in range(wide):
                if channel == 2 or channel == 3:
                    rows[row, place + w] = abs(low[w] - high[w])
                elif channel == 1 and w == wide - 1:
                    rows[row, place + 2 * wide - 2] = low[w] - high[w]
                else:
                    second = wide - 1 if channel == 1 else wide
                    rows[row, place + w] = low[w]
                    rows[row, place + second + w] = high[w]
                    if channel == 0:
                        ratio = (low[w] + _LEAST_WIDTH) / (high[w] + _LEAST_WIDTH)
                        rows[row, place + 2 * wide + w] = np.log(ratio)
            if channel == 0:
                place = rows.shape[1] - len(everywhere) - 7
                share = cut / slices
                part = (total[at] - total[_PAD]) / area
                rows[row, place], rows[row, place + 1] = share, 1 - share
                rows[row, place + 2], rows[row, place + 3] = part, 1 - part
                rows[row, place + 4], rows[row, place + 5] = lower[cut], upper[cut]
                rows[row, place + 6] = everywhere[1] - lower[cut] - upper[cut]
                for k in range(len(everywhere)):
                    rows[row, place + 7 + k] = everywhere[k]
        if channel == 0:
            column += 3 * wide
        elif channel == 1:
            column += 2 * wide - 1
        elif channel < 4:
            column += wide
        else:
            column += 2 * wide
    return rows


def _straightened(values: Array) -> Array:
    """Return values (SLICES,) less the straight line through them."""
    return np.asarray(values - values.mean() - _LINE * (_LINE @ values) / _LINE_SQUARED)
