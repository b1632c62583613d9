#!/usr/bin/env python3
"""Compares a window of cycles with the table of its whole run, bit by bit; of a program of hours it reads that part only.

  swarf run DIR/scene.toml --no-render --trajectory h5 -o DIR/out
  swarf export DIR/out --from 15000 --to 15002 --trajectory DIR/window.h5
  window_bits.py DIR/out/trajectory.h5 DIR/window.h5
"""
import sys

import h5py

with h5py.File(sys.argv[1]) as whole, h5py.File(sys.argv[2]) as window:
    period = float(whole.attrs["period_s"])
    count = len(window["t_s"])
    first = round(float(window["t_s"][0]) / period)
    assert count > 0 and set(whole) == set(window), "both have the same columns"
    for name in window:
        ours, theirs = window[name][:], whole[name][first:first + count]
        assert ours.dtype == theirs.dtype, name
        assert ours.tobytes() == theirs.tobytes(), f"{name} differs"
    print(f"{count} cycles from {first * period:.3f} s: all {len(window)} columns equal to the last bit")
