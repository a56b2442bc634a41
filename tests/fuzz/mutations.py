"""Damages texts and bytes. Every function takes the random numbers and what is to be damaged, and returns the damaged copy."""

import re

NUMBER = re.compile(rb"(?<![\w.])[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?![\w.])")

# Numbers at which types, ranges and signs end, and what is none
NUMBERS = [b"0", b"-0", b"-1", b"1", b"2", b"1e308", b"-1e308", b"1e309", b"5e-324", b"1e-300", b"1e18", b"nan", b"-nan", b"inf", b"-inf",
           b"127", b"128", b"32768", b"65536", b"2147483647", b"2147483648", b"-2147483649", b"4294967295", b"4294967296",
           b"9223372036854775807", b"9223372036854775808", b"18446744073709551615", b"18446744073709551616", b"1" * 400, b"0." + b"0" * 400 + b"1",
           b"0x10", b"1e", b"1.5.2", b"+-3", b"1,5", b"--", b"1e1e1", b"one", b""]

WORDS = [b"", b" ", b"\t", b"true", b"False", b"none", b",", b";", b":", b",,,,", b";;;;", b": :", b"1, 2, 3", b"1; 2", b"pin_top_1: 1",
         b"pin_top_1: nan, 1, 1", b"pin_top_1", b"pin_top_1: 1: 2", b"disc_bore: 1e10, 1e10", b"1000: 0.01, 500: 0.5", b"%s%n%x", b"`", b'"', b"'",
         b"{", b"}", b"\\", b"$(true)", b"/", b".", b"..", b"/dev/zero", b"/dev/null", b"/dev/stdin", b"/proc/self/mem", b"../" * 50,
         b"\xff\xfe", b"\xc3", b"\xe2\x82", b"\x1b[2J", b"\x7f", "μ".encode(), "１".encode(), b"x" * 300, b"x" * 100_000]


def random_bytes(random, length):
    return bytes(random.randrange(256) for _ in range(length))


def cut(random, data):
    return data[:random.randrange(len(data) + 1)]


def flip(random, data):
    """Single bytes become others."""
    changed = bytearray(data)
    for _ in range(random.choice([1, 1, 2, 5, 20])):
        if changed:
            changed[random.randrange(len(changed))] = random.randrange(256)
    return bytes(changed)


def insert(random, data):
    place = random.randrange(len(data) + 1)
    new = random.choice([random_bytes(random, random.choice([1, 4, 100])), random.choice(WORDS), b"\0", b"\r", b"\n", b"\\\n"])
    return data[:place] + new + data[place:]


def remove(random, data):
    first = random.randrange(len(data) + 1)
    return data[:first] + data[first + random.choice([1, 2, 10, 100, 1000]):]


def repeat(random, data):
    first = random.randrange(len(data) + 1)
    part = data[first:first + random.choice([1, 10, 100, 1000])]
    return data[:first] + part * random.choice([2, 3, 50]) + data[first:]


def exchange_numbers(random, data):
    """Numbers become others, of their own kind or not."""
    places = [match.span() for match in NUMBER.finditer(data)]
    for first, last in sorted(random.sample(places, min(len(places), random.choice([1, 1, 1, 2, 5]))), reverse=True):
        old = data[first:last]
        new = random.choice([random.choice(NUMBERS), data[slice(*random.choice(places))], b"-" + old, old + b"0", old + b"e5", old + b"e-5"])
        data = data[:first] + new + data[last:]
    return data


def lines_of(data):
    return data.split(b"\n")


def remove_lines(random, data):
    lines = lines_of(data)
    first = random.randrange(len(lines))
    del lines[first:first + random.choice([1, 1, 2, 10])]
    return b"\n".join(lines)


def repeat_line(random, data):
    lines = lines_of(data)
    lines.insert(random.randrange(len(lines) + 1), random.choice(lines))
    return b"\n".join(lines)


def exchange_lines(random, data):
    lines = lines_of(data)
    i, j = random.randrange(len(lines)), random.randrange(len(lines))
    lines[i], lines[j] = lines[j], lines[i]
    return b"\n".join(lines)


def long_line(random, data):
    lines = lines_of(data)
    place = random.randrange(len(lines))
    lines[place] += random.choice([b"x", b" 1", b"\xff", b"(", b"{", b"\\", b'"', b"a,"]) * random.choice([1000, 100_000, 1_000_000])
    return b"\n".join(lines)


def other_line_ends(random, data):
    return data.replace(b"\n", random.choice([b"\r\n", b"\r", b"\n\r", b"\n\n", b"\0\n", b"\v"]))


def other_encoding(random, data):
    text = data.decode("utf-8", "replace")
    return random.choice([text.encode("utf-16"), text.encode("utf-16-le"), text.encode("utf-32"), b"\xef\xbb\xbf" + data, b"\xef\xbb\xbf" * 2 + data,
                          data.upper(), data.replace(b"=", "＝".encode())])


OF_BYTES = [cut, flip, insert, remove, repeat]
OF_TEXT = [*OF_BYTES, exchange_numbers, exchange_numbers, exchange_numbers, remove_lines, repeat_line, exchange_lines, long_line, other_line_ends,
           other_encoding]


def damaged(random, data, mutations):
    """One damage, or a few."""
    for _ in range(random.choice([1, 1, 1, 2, 3])):
        data = random.choice(mutations)(random, data)
    return data
