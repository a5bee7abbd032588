"""Studies with participants: from consent to rows that ``hrcplan study report`` reads.

* ``study_file.py``: what a study is made of; ``plan.py``: who does what with which robot.
* ``participants.py``: what is stored of participants, and at which stage they are.
* ``trial_pages.py``, ``trial_routes.py``: what participants see, and the addresses of it.
* ``collect.py``: rows, traces and answers; ``rehearsal.py``: simulated participants.
"""
