"""Motion of several axes along one path: linear interpolation (GOL) and two-axis contours (PCOMP, PRUN)."""
