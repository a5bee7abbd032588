"""Turn-taking episodes: a human acts, then a robot that does not know the human's goal.

`hrcplan.episodes.episode.play` returns the `EpisodeRecord` of one episode; ``measures.py`` computes
measures of it.

What you can implement yourself:

* A world: `TurnWorld` with ``begin()`` and ``do(state, action)``. It is made from a bank, and named
  in ``worlds.WORLDS`` (entry-point group ``hrcplan.worlds``) or as ``module:Class``.
* A human: `EpisodeHuman` with ``move(turn, world, last)``. It is made from a bank and a `Course`,
  and named in ``humans.HUMANS`` (group ``hrcplan.humans``) or as ``module:Class``.
* A robot: see `hrcplan.assistance`.

Execution in continuous time is another engine: see `hrcplan.execution`.
"""
