"""Tests of volumes."""

import numpy as np
import pytest

import pxpl5


@pytest.fixture(scope="module")
def volume() -> pxpl5.Volume:
    return pxpl5.draw_volume("mig", {"display.width": 64, "display.height": 64})


def test_a_turn_has_the_slices_of_the_paper(volume: pxpl5.Volume) -> None:
    assert volume.slices == 396
    assert volume.report()["lit_voxels"] > 0


def test_bits_are_the_lit_voxels_of_the_report(volume: pxpl5.Volume) -> None:
    """The test counts the lit voxels one by one over all slices."""
    lit = sum(int(volume.bits(number).any(axis=2).sum()) for number in range(volume.slices))
    assert lit == volume.report()["lit_voxels"]


def test_a_slice_shows_its_bits(volume: pxpl5.Volume) -> None:
    fullest = max(range(0, volume.slices, 20), key=lambda number: int(volume.bits(number).sum()))
    assert np.array_equal(volume.slice(fullest).array > 0, volume.bits(fullest) > 0)


def test_an_eye_sees_something(volume: pxpl5.Volume) -> None:
    assert volume.view(40, 25, size=64).array.max() > 0
    assert volume._repr_png_().startswith(b"\x89PNG")


def test_wrong_settings_are_refused(volume: pxpl5.Volume) -> None:
    with pytest.raises(pxpl5.SettingError, match="display.width"):
        pxpl5.draw_volume("mig", {"display.wdth": 64})
    with pytest.raises(pxpl5.SettingError, match="0 to 395"):
        volume.slice(396)
    assert "clip.variant" in pxpl5.volume_keys()
