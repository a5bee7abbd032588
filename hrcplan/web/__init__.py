"""Pages: a live collaboration, its replay, plans, banks and studies in a browser.

Parts, from the inside to the outside:

* ``story.py``: what happens in a collaboration, as JSON entries in words; ``scene.py``: what of the
  world can be drawn, read off the PDDL. Both serve the live page and the page of a replay.
* ``live_session.py``, ``sessions.py``: collaborations that go on, one thread and one journal each.
* ``safety.py``: who may ask for what; every request passes it.
* ``app.py``, ``server.py``: the routes, and the server. Only these two and ``safety.py`` import the
  packages of the extra ``web``.
* ``static/``: the front end, plain modules without a build step.
"""
