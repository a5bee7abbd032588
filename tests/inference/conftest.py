"""What the tests of beliefs share besides the small worlds."""

from pathlib import Path

import pytest

from hrcplan.bank import Bank, build_bank

DATA = Path(__file__).parents[1] / "data" / "goal-recognition"


@pytest.fixture(scope="session")
def kitchen() -> Bank:
    return build_bank("kitchen")


@pytest.fixture(scope="session")
def instances() -> Path:
    return DATA
