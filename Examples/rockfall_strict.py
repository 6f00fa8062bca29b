"""Errors of sources and filters as exceptions, for scripts that must not go on with nothing.

    import rockfall_strict
    rockfall_strict.on()

ParaView prints what a source or filter has to say and goes on with an output of nothing. From `on()` to
`off()`, whatever updates a pipeline in this process (UpdatePipeline, SaveData, Fetch, FetchData, Show, Render,
SaveScreenshot, SaveAnimation and UpdatePipeline of a proxy) raises RockfallError with the first error of any
source or filter of RockfallDDA instead.
"""
import functools

from paraview import servermanager, simple

UPDATES = ("UpdatePipeline", "SaveData", "FetchData", "Show", "Render", "SaveScreenshot", "SaveAnimation")
kept = []  # what was put aside: owner, name, function


class RockfallError(RuntimeError):
    """An error of a source or filter."""


def error_of(proxy):
    """The error of a proxy's outputs, or None."""
    algorithm = proxy.GetClientSideObject()
    for port in range(proxy.SMProxy.GetNumberOfOutputPorts() if algorithm else 0):
        data = algorithm.GetOutputDataObject(port)
        error = data.GetFieldData().GetAbstractArray("Error") if data else None
        if error and error.GetNumberOfValues():
            return str(error.GetValue(0))
    return None


def check():
    """Raises RockfallError if a source or filter has nothing but an error."""
    for (name, _), proxy in simple.GetSources().items():
        error = error_of(proxy)
        if error:
            raise RockfallError(f"{name}: {error}")


def checked(function):
    @functools.wraps(function)
    def run(*arguments, **options):
        result = function(*arguments, **options)
        check()
        return result
    return run


def on():
    """Only names that are looked up from now on: call it before `from paraview.simple import *`."""
    if kept:
        return
    for owner, names in ((simple, UPDATES), (servermanager, ("Fetch",)),
                         (servermanager.SourceProxy, ("UpdatePipeline",))):
        for name in names:
            if hasattr(owner, name):
                kept.append((owner, name, getattr(owner, name)))
                setattr(owner, name, checked(getattr(owner, name)))


def off():
    while kept:
        setattr(*kept.pop())
