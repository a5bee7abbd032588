"""The live loop: a robot helps people whose goal it does not know, while both of them act.

Parts, from the inside to the outside:

* ``companion.py``: the pure state machine, ``step(run, event) -> (run, commands)``. It follows a
  belief about the goal. If there is one goal only it follows a plan, as `hrcplan.execution` does.
* ``history.py``: what was seen, in order. State and belief are folds over it, so that a step can be
  taken back.
* ``adviser.py``: answers the questions of the machine: which step, which plan, what was said.
* ``world.py``, ``persons.py``: where actions are carried out, and who acts: a simulated human, or
  a person at a terminal.
* ``collaborate.py``: `collaborate` returns a finished `Collaboration`.

Answers are events, so a journal is replayed without assistant, planner and reader.
"""
