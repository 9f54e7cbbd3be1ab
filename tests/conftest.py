import pathlib

import pytest


def pytest_addoption(parser):
    parser.addoption("--program", type=pathlib.Path, default=pathlib.Path("build/gaitpad"))


@pytest.fixture(scope="session")
def program(pytestconfig):
    return pytestconfig.getoption("--program").resolve()
