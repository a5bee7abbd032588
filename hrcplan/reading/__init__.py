"""What people say, read as one of the steps that are possible now.

>>> from hrcplan.pddl.inputs import read
>>> from hrcplan.reading import make_lexicon, read_words
>>> lexicon = make_lexicon(read("kitchen", "oatmeal-berry"))
>>> steps = [("get", "oats"), ("get", "nuts"), ("turn_on", "stove")]
>>> reading = read_words(lexicon, "I'm getting the oats", steps)
>>> reading.outcome.value, reading.step
('act', 0)
"""

from hrcplan.reading.lexicon import Lexicon, make_lexicon
from hrcplan.reading.reader import Reading, ReadingOutcome, read_words

__all__ = ["Lexicon", "Reading", "ReadingOutcome", "make_lexicon", "read_words"]
