"""What may stand in a study.json: plain JSON, and in its parts the properties of the proxies, each of the
type, length and range that its XML gives it."""
import json
import math

from paraview import servermanager

# The proxy whose properties a part sets: group and name in the XML.
PROXIES = {
    "terrain": ("sources", "DEMToCFEMesh"), "rocks": ("sources", "RockBlocks"),
    "simulation": ("filters", "RockfallSimulation"), "map": ("writers", "HazardPassageWriter"),
    "lines": ("filters", "TrajectoryCollector")}
# Of what is made of all chunks in the end, whose properties the part sets as well.
FURTHER = {"map": ("sources", "HazardPassageReader"), "lines": ("filters", "BarrierDesign")}
MOST_ITERATIONS = 2**31 - 1  # the simulation's own limit
MOST_CHUNKS = 100000  # as many as the names of their files have digits for


class Bad(Exception):
    """A study that cannot be; the text says where and why."""


def shown(value):
    """A value as it stands in a message."""
    try:
        text = json.dumps(value, default=str)
    except RecursionError:
        return "nested too deeply"
    return text if len(text) <= 60 else text[:57] + "..."


def without_repeats(pairs):
    result = {}
    for name, value in pairs:
        if name in result:
            raise Bad(f"{shown(name)} is there twice")
        result[name] = value
    return result


def no_number(word):
    raise Bad(f"{word} is no number of JSON")


def check_text(where, text):
    if any(ord(c) < 32 or 0xD800 <= ord(c) < 0xE000 for c in text):
        raise Bad(f"{where} is {shown(text)}: it has a character that no name has")


def load(path):
    """The object of a JSON file."""
    try:
        with open(path, encoding="utf-8-sig") as file:
            study = json.load(file, parse_constant=no_number, object_pairs_hook=without_repeats)
    except OSError as error:
        raise Bad(f"{path}: {error.strerror or error}") from None
    except Bad as bad:
        raise Bad(f"{path} is not JSON: {bad}") from None
    except RecursionError:
        raise Bad(f"{path} is not JSON of a study: it is nested too deeply") from None
    except ValueError as error:
        raise Bad(f"{path} is not JSON: {error}") from None
    if not isinstance(study, dict):
        raise Bad(f"{path} must be an object with terrain, rocks, simulation, iterations and chunk")
    return study


def properties_of(part):
    """A part's properties by the names that scripts know them by."""
    further = properties_at(FURTHER[part]) if part in FURTHER else {}
    further.pop("FileNames", None)  # the chunks'
    return {**further, **properties_at(PROXIES[part])}


def shared_out(part, values):
    """The values of a part: those of its proxy, and those of what is made of all chunks."""
    own = properties_at(PROXIES[part])
    return ({name: value for name, value in values.items() if name in own},
            {name: value for name, value in values.items() if name not in own})


def properties_at(place):
    group, name = place
    proxy = servermanager.ProxyManager().GetPrototypeProxy(group, name)
    if not proxy:
        raise Bad(f"the plugin RockfallDDA has no {name}")
    result = {}
    properties = proxy.NewPropertyIterator()
    properties.UnRegister(None)
    properties.Begin()
    while not properties.IsAtEnd():
        label = properties.GetProperty().GetXMLLabel() or properties.GetKey()
        for key in (properties.GetKey(), servermanager._make_name_valid(label)):
            result[key] = properties.GetProperty()
        properties.Next()
    return result


def takes_truth(prop):
    return bool(prop.FindDomain("vtkSMBooleanDomain"))


def check_number(where, value, prop):
    whole = not prop.IsA("vtkSMDoubleVectorProperty")
    if isinstance(value, bool) and not takes_truth(prop):
        raise Bad(f"{where} is {shown(value)}, it must be a number")
    names = prop.FindDomain("vtkSMEnumerationDomain") if whole else None
    if names and isinstance(value, str):
        known = [names.GetEntryText(k) for k in range(names.GetNumberOfEntries())]
        if value not in known:
            raise Bad(f"{where} is {shown(value)}, it must be one of {', '.join(known)}")
        return
    if whole and (not isinstance(value, int) or abs(value) >= 2**31):
        raise Bad(f"{where} is {shown(value)}, it must be a whole number of at most 2147483647")
    if not isinstance(value, (int, float)):
        raise Bad(f"{where} is {shown(value)}, it must be a number")
    if abs(value) > 1e300 or not math.isfinite(value):
        raise Bad(f"{where} is {shown(value)}, more than a number can be")
    bounds = prop.FindDomain("vtkSMIntRangeDomain" if whole else "vtkSMDoubleRangeDomain")
    if bounds and bounds.GetMinimumExists(0) and value < bounds.GetMinimum(0):
        raise Bad(f"{where} is {shown(value)}, it must be at least {bounds.GetMinimum(0):g}")
    if bounds and bounds.GetMaximumExists(0) and value > bounds.GetMaximum(0):
        raise Bad(f"{where} is {shown(value)}, it must be at most {bounds.GetMaximum(0):g}")


def check_value(where, value, prop):
    if not prop.IsA("vtkSMVectorProperty") or prop.IsA("vtkSMProxyProperty"):
        raise Bad(f"{where} is what this script sets")
    single = prop.GetNumberOfElements() == 1 and not prop.GetRepeatCommand()
    if single and isinstance(value, (list, dict)):
        raise Bad(f"{where} is {shown(value)}, it must be a single value")
    if not single and not isinstance(value, list):
        raise Bad(f"{where} is {shown(value)}, it must be a list")
    if not single and not prop.GetRepeatCommand() and len(value) != prop.GetNumberOfElements():
        raise Bad(f"{where} has {len(value)} values, it must have {prop.GetNumberOfElements()}")
    for one in [value] if single else value:
        if not prop.IsA("vtkSMStringVectorProperty"):
            check_number(where, one, prop)
        elif not isinstance(one, str):
            raise Bad(f"{where} is {shown(one)}, it must be a text")
        else:
            check_text(where, one)


def described(prop):
    """JSON Schema of what check_value takes; None for what this script sets."""
    if not prop.IsA("vtkSMVectorProperty") or prop.IsA("vtkSMProxyProperty"):
        return None
    if prop.IsA("vtkSMStringVectorProperty"):
        one = {"type": "string", "pattern": "^[^\\x00-\\x1f]*$"}
    else:
        whole = not prop.IsA("vtkSMDoubleVectorProperty")
        one = {"type": ["integer", "boolean"] if takes_truth(prop) else "integer" if whole else "number"}
        bounds = prop.FindDomain("vtkSMIntRangeDomain" if whole else "vtkSMDoubleRangeDomain")
        if bounds and bounds.GetMinimumExists(0):
            one["minimum"] = bounds.GetMinimum(0)
        if bounds and bounds.GetMaximumExists(0):
            one["maximum"] = bounds.GetMaximum(0)
        names = prop.FindDomain("vtkSMEnumerationDomain") if whole else None
        if names:
            one = {"anyOf": [{"enum": [names.GetEntryText(k) for k in range(names.GetNumberOfEntries())]}, one]}
    text = prop.GetDocumentation() and prop.GetDocumentation().GetDescription()
    told = {"description": " ".join(text.split())} if text else {}
    if prop.GetNumberOfElements() == 1 and not prop.GetRepeatCommand():
        return {**told, **one}
    count = {} if prop.GetRepeatCommand() else dict.fromkeys(("minItems", "maxItems"), prop.GetNumberOfElements())
    return {**told, "type": "array", "items": one, **count}


def json_schema():
    """What `check` takes, for editors: JSON Schema of a study.json."""
    parts = {}
    for part in PROXIES:
        known = {name: described(prop) for name, prop in sorted(properties_of(part).items())}
        parts[part] = {"type": "object", "additionalProperties": False,
                       "properties": {name: one for name, one in known.items() if one}}
    count = {"type": "integer", "minimum": 1, "maximum": MOST_ITERATIONS}
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "study.json of RockfallDDA",
            "type": "object", "required": ["iterations", "chunk"], "additionalProperties": False,
            "properties": {**parts, "$schema": {"type": "string"}, "trajectories": {"type": "boolean"},
                           "iterations": count, "chunk": count, "until": {"type": "object"}}}


def check(path, study):
    """All of a study but what its files hold."""
    known = {**dict.fromkeys(PROXIES, dict), "trajectories": bool, "iterations": int, "chunk": int,
             "until": dict, "$schema": str}
    try:
        for key, value in study.items():
            if key not in known:
                raise Bad(f"there is no {shown(key)} in a study, it knows {', '.join(known)}")
            if type(value) is not known[key]:
                kind = {dict: "an object", bool: "true or false", int: "a whole number", str: "a text"}[known[key]]
                raise Bad(f"\"{key}\" is {shown(value)}, it must be {kind}")
        for key in ("iterations", "chunk"):
            if not 1 <= study.get(key, 0) <= MOST_ITERATIONS:
                raise Bad(f"\"{key}\" is {shown(study[key]) if key in study else 'missing'}, it must be "
                          f"at least 1 and at most {MOST_ITERATIONS}")
        if study["iterations"] > MOST_CHUNKS * study["chunk"]:
            raise Bad(f"\"chunk\" is {study['chunk']}: {study['iterations']} iterations would be more than "
                      f"{MOST_CHUNKS} chunks")
        for part in filter(study.__contains__, PROXIES):
            properties = properties_of(part)
            for name, value in study[part].items():
                where = f"{shown(name)} of {part}"
                if name not in properties:
                    raise Bad(f"{part}: there is no property {shown(name)}")
                check_value(where, value, properties[name])
        often = [study.get(part, {}).get("AnnualFrequency", 0) for part in ("map", "lines")]
        if all(often) and often[0] != often[1]:
            raise Bad(f"AnnualFrequency of map is {often[0]}, of lines {often[1]}: both are of all rocks together")
    except Bad as bad:
        raise Bad(f"{path}: {bad}") from None
