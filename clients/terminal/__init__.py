"""The interactive terminal: `python -m clients PORT`, also `oem6250 terminal PORT`.

What is typed goes to the unit line by line, what the unit says is shown as it comes, whether it was asked for or not:
no answer is waited for, so a `GO` that answers when the move is over holds nothing up. Around that stand completion
from the catalogue, status words in words, and programs loaded from files and saved to them. The guide is
docs/terminal.md.

`incoming`, `decoding`, `completion` and `program_files` are pure; `conversation` keeps the port, `commands` are the
terminal's own, `console` is the screen and the only module that needs prompt_toolkit.
"""
