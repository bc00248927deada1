"""Non-volatile memory: what a unit keeps over power-off, in a file that survives the process and the computer.

``contents``  what is kept, as plain values, and as rows        ``store``   the SQLite file
``keeper``    the thread that writes                             ``text``    the readable form
``memory``    the file with the units, replies held back until    ``sense``   whether contents make sense
              what precedes them is durable
``command``   ``oem6250 state``                                 ``errors``  what can be wrong with a file

A controller knows ``contents`` alone; nothing here is imported before a file is asked for.
"""
