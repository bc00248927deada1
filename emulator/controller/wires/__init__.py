"""The terminals: inputs and what they do, outputs and what drives them, analogue channels, operator panel."""
