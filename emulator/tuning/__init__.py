"""Tuning help: step responses measured as the guide defines it, the guide's procedure walked, sweeps over gains.

Nothing is imported here: `oem6250 --help` and the servo itself must not pay for numpy batches or pictures.
"""

SWEPT_GAINS = ("SGP", "SGI", "SGV", "SGVF", "SGAF", "SGILIM")
"""The gains a sweep can vary."""
