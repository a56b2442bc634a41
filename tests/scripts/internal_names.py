"""Names that belong to one source file alone, in namespaces without a name or `static`, found in its text.

A unity build joins files, and such names of several files meet there. As files are laid out by clang-format, their text tells enough. Of several
variables in one declaration the first one is found.
"""

import re

# Texts and comments go, so that braces and semicolons of the code are left, and directives with them
RAW_TEXT = re.compile(r'R"\((?:.|\n)*?\)"')
TEXT_OR_COMMENT = re.compile(r'("(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\')|//[^\n]*|/\*(?:.|\n)*?\*/')
DIRECTIVE = re.compile(r"^\s*#(?:.*\\\n)*.*$", re.MULTILINE)


def internal_declarations(text):
    """Declarations at the level of a namespace that no other file sees, up to their bodies."""
    text = TEXT_OR_COMMENT.sub(lambda match: '""' if match[1] else " ", RAW_TEXT.sub('""', text))
    found, namespaces, depth, head = [], [], 0, ""  # depth of braces within the innermost namespace
    for token in re.findall(r"[{};]|[^{};]+", DIRECTIVE.sub("", text)):
        if token == "{" and depth == 0 and (namespace := re.fullmatch(r"namespace\s*([\w:]*)", head.strip())):
            namespaces.append(namespace[1])
            head = ""
        elif token in "{;":
            head = " ".join(head.split())
            # What begins with a comma or a bracket goes on behind a brace
            if depth == 0 and head and head[0] not in ",)." and ("" in namespaces or head.startswith("static ")):
                found.append(head)
            depth += token == "{"
            head = ""
        elif token == "}":
            if depth > 0:
                depth -= 1
            else:
                namespaces.pop()
        elif depth == 0:
            head += token
    return found


def arguments(text):
    """Parts between commas that no bracket encloses, up to the bracket that closes the list."""
    parts, depth = [""], 0
    for character in text:
        depth += (character in "(<[") - (character in ")>]")
        if depth < 0:
            break
        if character == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += character
    return parts


def argument_type(argument):
    """The type without the name, the default, and `const` of a copy."""
    text = re.sub(r"\s*=.*|\[\]$", "", argument.strip())
    text = re.sub(r"(?<=[\s&*>])\w+$", "", text).strip()
    return text if text.endswith(("&", "*")) else text.removeprefix("const ")


def named(head):
    """Name, kind, and what tells functions and aliases of one name apart; nothing for declarations that may come again."""
    while head.startswith("template <"):
        parameters = ",".join(arguments(head.removeprefix("template <")))
        if not parameters:
            return None  # a specialisation
        head = head.removeprefix(f"template <{parameters}>").strip()
    if alias := re.fullmatch(r"(?:using|namespace) (\w+) = (.*)", head):
        return alias[1], "alias", alias[2]
    if re.match(r"(?:using|extern|static_assert)\b", head):
        return None
    if kind := re.fullmatch(r"(?:enum |struct |class |union )+(\w+)(?: final)?(?: ?: .*)?", head):
        return kind[1], "type", ""
    # Arguments of a template may be types of functions
    before, bracket, after = re.sub(r"<[^()]*\([^()]*\)>", "<>", head).partition("(")
    types = [argument_type(argument) for argument in arguments(after)]
    if bracket and " = " not in before and not any(re.match(r'["\d]', text) for text in types):
        function = re.search(r"(operator\W+|\w+)$", before)
        return (function[1], "function", ", ".join(types)) if function else None
    variable = re.search(r"(\w+)(?:\[.*\])?$", re.sub(r" =.*", "", before))
    return (variable[1], "variable", "") if variable else None


def is_clash(one, other):
    """Whether two declarations of one name, (kind, detail), cannot stand in one file."""
    if one[0] == other[0] == "function":
        return one[1] == other[1]
    return one[0] != "alias" or one != other


def clashes(files, most_apart):
    """Sentences on names of two files, pairs (file, text) in the order of a unity build, that lie at most so many files apart."""
    seen, sentences = {}, []
    for place, (file, text) in enumerate(files):
        for declaration in filter(None, map(named, internal_declarations(text))):
            name, what = declaration[0], declaration[1:]
            for place_there, file_there, what_there in seen.setdefault(name, []):
                if 0 < place - place_there <= most_apart and is_clash(what, what_there):
                    sentences.append(f"{name} in {file_there} and {file}")
            seen[name].append((place, file, what))
    return sentences
