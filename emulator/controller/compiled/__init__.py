"""Compiled motion: programs that PCOMP turns into segments and PRUN carries out.

`kinds` says what a kind of compiled motion (an individual-axis profile, a contour path) must offer and keeps the list
of kinds; `compiling` walks a stored program and hands its commands to the builder of its kind; `store` is compiled
memory and what is running; `commands` are PCOMP, PUCOMP, PRUN and TSEG.
"""
