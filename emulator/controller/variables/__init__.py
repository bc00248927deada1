"""Variables, data and timers, the operands of expressions, and the commands that read and write them."""
