"""What makes a study this one: the values of its parts, the content of every file that its data sets
consist of, and the version of the program."""
import ctypes
import hashlib
import os

from paraview import servermanager

import schema

FILES = ("FileName", "File", "Layer", "Table")  # a property whose name ends so is a file
FORMAT = 5  # of the files of a study: another one is another study
# Companions that GDAL reads but does not list, or lists only for some formats: with their ending
# instead of the file's own, or behind it.
COMPANIONS = (".dbf", ".shx", ".prj", ".cpg", ".csvt", ".tfw", ".wld", ".ovr", ".xsd"), \
    (".aux.xml", ".msk", ".ovr", "-wal", "-journal")


class Changed(Exception):
    """An input is not what it was; the text says which."""


def version():
    """Of the plugin that is loaded; ParaView 6.1 has none of its plugins'."""
    run = servermanager.filters.RockfallSimulation().SMProxy
    run.UpdatePropertyInformation()
    return run.GetProperty("ProgramVersion").GetElement(0)


def gdal():
    """The GDAL that the plugin reads with, or None if it is linked statically."""
    with open("/proc/self/maps", encoding="utf-8", errors="replace") as maps:
        for line in maps:
            path = line.split(maxsplit=5)[-1].strip()
            if os.path.basename(path).startswith("libgdal.so"):
                library = ctypes.CDLL(path)
                library.GDALOpenEx.restype = ctypes.c_void_p
                library.GDALOpenEx.argtypes = [ctypes.c_char_p, ctypes.c_uint] + 3 * [ctypes.c_void_p]
                library.GDALGetMetadata.restype = ctypes.c_void_p
                library.GDALGetMetadata.argtypes = [ctypes.c_void_p, ctypes.c_char_p]
                library.GDALGetFileList.restype = ctypes.POINTER(ctypes.c_char_p)
                library.GDALGetFileList.argtypes = [ctypes.c_void_p]
                library.CSLDestroy.argtypes = [ctypes.POINTER(ctypes.c_char_p)]
                library.GDALClose.argtypes = [ctypes.c_void_p]
                library.CPLPushErrorHandler.argtypes = [ctypes.c_void_p]
                return library
    return None


def listed(path):
    """The files that GDAL says a data set consists of. Only for one that a reader has taken: it looks
    whether the file names addresses or files elsewhere, and this does not."""
    library = gdal()
    if not library:
        return []
    library.CPLPushErrorHandler(ctypes.cast(library.CPLQuietErrorHandler, ctypes.c_void_p))
    try:
        dataset = library.GDALOpenEx(os.fsencode(path), 0x02 | 0x04, None, None, None)  # raster, vector
        if not dataset:
            return []
        library.GDALGetMetadata(dataset, None)  # GDAL 3.10 writes those that nobody asked for
        files, names = library.GDALGetFileList(dataset), []
        while files and files[len(names)]:
            names.append(files[len(names)])
        library.CSLDestroy(files)
        library.GDALClose(dataset)
        return [os.fsdecode(name) for name in names]
    finally:
        library.CPLPopErrorHandler()


def companions(path):
    """Names that GDAL looks for beside a file."""
    stem = os.path.splitext(path)[0]
    return [stem + end for end in COMPANIONS[0]] + [path + end for end in COMPANIONS[1]]


def members(path, ask=True):
    """All files of a data set that say something, the file itself first, or all of a folder (Zarr);
    without `ask` only those that lie beside it under its name."""
    kept, within = {path: None}, []
    if os.path.isdir(path):
        kept = {}
        within = [os.path.join(folder, name) for folder, _, names in sorted(os.walk(path)) for name in sorted(names)]
    for one in map(os.path.abspath, within + (listed(path) if ask else []) + companions(path)):
        if os.path.isfile(one) and os.path.getsize(one) > 0:
            kept[one] = None
    return list(kept)


def signature(path):
    """Changes whenever a file is written or replaced; quicker to have than its content."""
    try:
        status = os.stat(path)
    except OSError:
        return None
    return status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns, status.st_ctime_ns


def content(path):
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        while block := file.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()


def place(path, main):
    """A member's name without that of the data set, which may be called otherwise."""
    if path == main:
        return "content"
    stem = os.path.splitext(main)[0]
    return path[len(stem):] if path.startswith(stem) else os.path.relpath(path, os.path.dirname(main))


class Inputs:
    """The files of a study, as they are when it begins."""

    def __init__(self, study):
        self.main = {(part, name): os.path.abspath(value)
                     for part in filter(study.__contains__, schema.PROXIES)
                     for name, value in sorted(study[part].items()) if name.endswith(FILES) and value}
        self.before = {}
        for folder in {os.path.dirname(path) for path in self.main.values()}:
            for name in os.listdir(folder):
                self.before[os.path.join(folder, name)] = signature(os.path.join(folder, name))
        self.sets, self.digests, self.signatures = {}, {}, {}

    def look(self, ask):
        for path in set(self.main.values()):
            self.sets[path] = members(path, ask)
            for one in self.sets[path]:
                now = signature(one)
                if self.signatures.get(one) != now or one not in self.digests:
                    self.signatures[one], self.digests[one] = now, content(one)

    def read(self):
        """Once they have been taken by the readers: what they consist of, and a hash of each file."""
        self.look(True)
        folders = {os.path.dirname(main) for main in self.main.values()}
        for one, now in self.signatures.items():
            if os.path.dirname(one) in folders and self.before.get(one) != now:
                raise Changed(f"{one} changed while the study read it. Start it again")

    def check(self):
        """Raises Changed if a file is not what it was. One that was only touched is the same."""
        for path, there in self.sets.items():
            for one in companions(path):
                if one not in there and os.path.isfile(one) and os.path.getsize(one) > 0:
                    raise Changed(f"{one} came while the study ran")
            for one in there:
                now = signature(one)
                if now is None:
                    raise Changed(f"{one} went away while the study ran")
                if now != self.signatures[one] and content(one) != self.digests[one]:
                    raise Changed(f"{one} changed while the study ran")
                self.signatures[one] = now

    def of(self, part, name):
        """What a property's data set is, by content."""
        main = self.main[part, name]
        return {place(one, main): "sha256 " + self.digests[one] for one in self.sets[main]}

    def names(self):
        return {f"{part} {name}": self.sets[path] for (part, name), path in self.main.items()}


def identity(study, inputs):
    """All that the results of an iteration depend on. Not their number: more of them are the same
    study."""
    result = {"format": FORMAT, "version": version()}
    result.update((key, study[key]) for key in ("trajectories", "chunk"))
    for part in filter(study.__contains__, schema.PROXIES):
        result[part] = {name: inputs.of(part, name) if (part, name) in inputs.main else value
                        for name, value in sorted(study[part].items())}
    return result


def early(old, study, inputs):
    """What differs for sure, before any reader looks at a file."""
    inputs.look(False)
    new = identity(study, inputs)
    for part, name in inputs.main:
        before = old[part].get(name) if isinstance(old.get(part), dict) else None
        if isinstance(before, dict):
            new[part][name] = {**before, **new[part][name]}
    return differences(old, new)


def differences(old, new, where=""):
    """Names of what two identities differ in."""
    names = []
    for key in sorted(set(old) | set(new)):
        if old.get(key) != new.get(key):
            if isinstance(old.get(key), dict) and isinstance(new.get(key), dict):
                names += differences(old[key], new[key], f"{where}{key} ")
            else:
                names.append(where + key)
    return names


def told(names, inputs):
    """Differences for a person: a file by its name."""
    texts = []
    for name in names:
        words = name.split(" ", 2)
        path = inputs.main.get(tuple(words[:2]))
        if path and len(words) == 3:
            end = "" if words[2] == "content" else f", by what belongs to it: {words[2]}"
            name = f"{words[0]} {words[1]} ({path}{end})"
        texts.append(name)
    return ", ".join(texts)


def values(proxies):
    """All values in force of proxies by part: those of the study and the defaults. A choice by its name."""
    simple = (bool, int, float, str)
    result = {}
    for part, proxy in proxies.items():
        result[part] = {}
        for name in proxy.ListProperties():
            if proxy.GetProperty(name).SMProperty.GetInformationOnly():
                continue
            try:
                value = proxy.GetPropertyValue(name)
            except (AttributeError, RuntimeError):
                continue
            data = value.GetData() if hasattr(value, "GetData") else value
            if data is None or isinstance(data, simple):
                result[part][name] = data
            elif isinstance(data, (list, tuple)) and all(isinstance(one, simple) for one in data):
                result[part][name] = list(data)
    return result
