"""What the ranks of a study do together: the first one alone looks at files and talks."""
import json
import os

from paraview import servermanager
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray
from vtkmodules.vtkParallelCore import vtkMultiProcessController

import identity
import schema
import wholefile

controller = vtkMultiProcessController.GetGlobalController()
# Without --sym the first rank alone runs the script.
symmetric = controller is not None and controller.GetNumberOfProcesses() > 1 and \
    servermanager.vtkProcessModule.GetProcessModule().GetSymmetricMPIMode()
ranks = controller.GetNumberOfProcesses() if symmetric else 1
first_rank = not symmetric or controller.GetLocalProcessId() == 0


class Refused(Exception):
    """The study cannot be done; the text says why."""


def say(text):
    if first_rank:
        print(text, flush=True)


def refuse(text):
    raise Refused(text)


def from_first_rank(work):
    """What work() gives there, on every rank: no other one looks at files. A refusal ends all."""
    answer = ""
    if first_rank:
        try:
            answer = json.dumps([None, work()])
        except (Refused, schema.Bad, identity.Changed) as refusal:
            answer = json.dumps([str(refusal), None])
        except OSError as error:
            answer = json.dumps([f"{error.filename}: {error.strerror or type(error).__name__}", None])
        except MemoryError:
            answer = json.dumps(["There is not enough memory for this chunk: take a smaller one", None])
    if symmetric:
        array = vtkUnsignedCharArray()
        for byte in answer.encode():
            array.InsertNextValue(byte)
        controller.Broadcast(array, 0)
        answer = bytes(array.GetValue(k) for k in range(array.GetNumberOfValues())).decode()
    refusal, result = json.loads(answer)
    if refusal is not None:
        raise SystemExit(refusal if first_rank else 1)
    return result


def output(proxy, port=0):
    """What a proxy made on this rank. Ends all ranks if the first has nothing but an error."""
    data = proxy.GetClientSideObject().GetOutputDataObject(port)

    def check():
        error = data.GetFieldData().GetAbstractArray("Error")
        if error:
            refuse(f"The study cannot be done: {error.GetValue(0)}")

    from_first_rank(check)
    return data


def write_by(writer, path):
    """Has a writer's proxy write its file, on the first rank; the other ranks take part."""
    unfinished = wholefile.unfinished(path)

    def remove():
        if os.path.exists(unfinished):
            os.remove(unfinished)

    def keep():
        if not os.path.exists(unfinished):
            refuse(f"{path} could not be made; the message above says why.")
        wholefile.keep(path)

    from_first_rank(remove)
    writer.FileName = unfinished
    writer.UpdatePipeline()
    from_first_rank(keep)


def make(source, label, properties):
    try:
        return source(**properties)
    except (AttributeError, ValueError, TypeError, RuntimeError) as error:
        # The same on every rank.
        raise SystemExit(f"{label}: {error}" if first_rank else 1)
