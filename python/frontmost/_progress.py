# SPDX-License-Identifier: Apache-2.0
"""The progress bar of long calls: tqdm's where it is there, else one line on standard error."""
import sys
import time


class Bar:
    """Called with a stage and how much of it is done, 0 to 1. Shows nothing for the first half second."""

    def __init__(self):
        self._shown_from = time.monotonic() + 0.5
        self._stage = None
        self._bar = None

    def __call__(self, stage, fraction):
        if time.monotonic() < self._shown_from:
            return
        try:
            from tqdm.auto import tqdm
        except ImportError:
            self._stage = stage
            sys.stderr.write(f"\r\x1b[K{stage} {fraction:4.0%}")
            sys.stderr.flush()
            return
        if self._bar is None or stage != self._stage:
            self.close()
            self._stage = stage
            self._bar = tqdm(total=100, desc=stage, unit="%", leave=False)
        self._bar.n = round(100 * fraction)
        self._bar.refresh()

    def close(self):
        """Takes the bar away."""
        if self._bar is not None:
            self._bar.close()
            self._bar = None
        elif self._stage is not None:
            sys.stderr.write("\r\x1b[K")
            sys.stderr.flush()
        self._stage = None
