#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Numbers as Python and JavaScript write them in JSON, one per line: write_numbers.py SEED COUNT. Among them are doubles,
floats, midpoints of neighbouring floats, subnormal numbers and integers beyond 2^63. numbers.txt is the output of 1 12."""
import json, random, shutil, struct, subprocess, sys


def double_of(bits):
    return struct.unpack("<d", struct.pack("<Q", bits))[0]


def float_of(bits):
    return struct.unpack("<f", struct.pack("<I", bits))[0]


def values(count):
    sign = random.choice
    for _ in range(count):
        yield sign((-1, 1)) * double_of(random.randrange(0x7FF0000000000000))
        yield sign((-1, 1)) * float_of(random.randrange(0x7F800000))
        yield random.uniform(-300, 300)
        near = random.randrange(0x3C000000, 0x43800000)  # floats from 0.008 to 256
        yield sign((-1, 1)) * (float_of(near) + float_of(near + 1)) / 2
        far = random.randrange(0x7F7FFFFE)
        yield (float_of(far) + float_of(far + 1)) / 2
        yield double_of(random.randrange(1 << 52))
        yield float_of(random.randrange(1 << 23))
        yield float(random.randrange(-(1 << 53), 1 << 53))
    yield from (9.745131015777588, 0.0, -0.0, 5e-324, 2.2250738585072014e-308, 1.7976931348623157e308)


def written_by_node(numbers):
    bits = " ".join(struct.pack(">d", number).hex() for number in numbers)
    program = ("for (const word of require('fs').readFileSync(0, 'utf8').split(' '))"
               " console.log(JSON.stringify(Buffer.from(word, 'hex').readDoubleBE()));")
    return subprocess.run(["node", "-e", program], input=bits, capture_output=True, text=True, check=True).stdout


def main():
    random.seed(int(sys.argv[1]))
    numbers = list(values(int(sys.argv[2])))
    for number in numbers:
        print(json.dumps(number))
    for integer in (0, -1, 2**31, 2**53 + 1, 2**63 - 1, 2**63, -2**63, 2**64, 10**20, random.randrange(2**63)):
        print(json.dumps(integer))
    if shutil.which("node"):
        print(written_by_node(numbers), end="")


main()
