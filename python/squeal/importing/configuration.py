# SPDX-License-Identifier: GPL-3.0-or-later

"""Reads the configuration of an import from YAML or JSON."""

import json
import pathlib

from squeal.errors import Error


def read_json(path):
    """The content of a JSON file. Raises Error for duplicate names in an object."""
    def without_repetition(pairs):
        names = [name for name, _ in pairs]
        if repeated := next((name for name in names if names.count(name) > 1), None):
            raise ValueError(f"`{repeated}` appears twice")
        return dict(pairs)

    try:
        return json.loads(path.read_text(encoding="utf-8"), object_pairs_hook=without_repetition)
    except FileNotFoundError:
        raise Error("the file is missing", path, "add it, or correct its name") from None
    except (OSError, ValueError) as problem:
        raise Error(f"the file cannot be read: {problem}", path, "correct the file or its permissions") from problem


def read_yaml(path, what):
    """The content of a YAML or JSON file. Raises Error for invalid syntax and for duplicate keys, which PyYAML accepts."""
    import yaml

    class Loader(yaml.SafeLoader):
        def construct_mapping(self, node, deep=False):
            if len({key.value for key, _ in node.value}) < len(node.value):
                raise ValueError(f"a name appears twice{node.start_mark}")
            return super().construct_mapping(node, deep)

    try:
        return yaml.load(pathlib.Path(path).read_text(encoding="utf-8").expandtabs(), Loader)
    except (ValueError, TypeError, yaml.YAMLError) as error:
        raise Error(f"the {what} cannot be read: " + " ".join(str(error).split()), path, "write valid YAML or JSON") from error
