"""Changes of a scene's files: bytes of any, words and numbers of text, and what lies packed within others."""

from __future__ import annotations

import random
import re
import zlib

from import_seeds import Case, serialized

LARGEST = 1 << 16  # bytes of a file
_TOKEN = re.compile(rb'[A-Za-z_][\w.\-]*|[+-]?[\d.]+(?:[eE][+-]?\d+)?|"[^"\n]*"|<[^<>]*>|\S')
_LINE = re.compile(rb"[^\n]*\n")
_NUMBERS = (b"0", b"-0", b"1", b"-1", b"0.5", b"2", b"3", b"nan", b"inf", b"-inf", b"1e300", b"-1e300", b"1e-300", b"1e38",
            b"1e19", b"255", b"65535", b"65536", b"100000", b"2147483647", b"2147483648", b"4294967295",
            b"18446744073709551616", b"0x10", b"1_0", b"1f", b"$grey", b"", b"1 2", b"1,2,3", b"#ff8000", b"true")
_BYTES = (b"\0", b"\xff", b"\x7f", b"\x80", b"\xff\xff\xff\xff", b"\0\0\0\x80", b"\0\0\xc0\x7f", b"\0\0\x80\x7f",
          b"\n", b'"', b"<", b">", b"[", b"]", b"&#0;", b"]]>", b"<!--", b"\xef\xbb\xbf", b"\r\n", b"\xc3")


class Mutator:
    def __init__(self, source: random.Random, words: list[bytes]) -> None:
        self.source = source
        self._words = words
        self._of_bytes = [self._overwrite, self._insert, self._delete, self._copy, self._flip, self._cut]
        self._of_text = [self._number, self._word, self._drop_token, self._repeat_token, self._swap_tokens, self._drop_line,
                         self._repeat_line, self._move_line, self._number, self._word]

    def changed(self, cases: list[Case]) -> Case:
        """One of the cases with one or two files changed; now and then one is another's before."""
        result = dict(self.source.choice(cases))
        for _ in range(self.source.choice((1, 1, 1, 2))):
            name = self.source.choice(list(result))
            if self.source.random() < 0.03:
                result[name] = self.source.choice(list(self.source.choice(cases).values()))
            for _ in range(self.source.choice((1, 1, 2, 3, 8))):
                result[name] = self._changed_file(name, result[name])[:LARGEST]
        return result

    def _changed_file(self, name: str, data: bytes) -> bytes:
        if name.endswith(".serialized") and self.source.random() < 0.7:
            return self._within_serialized(data)
        if name.endswith(".png") and self.source.random() < 0.7:
            return self._with_sums(self._byte_change(data))
        is_text = b"\0" not in data[:200]
        if is_text and self.source.random() < 0.8:
            return self.source.choice(self._of_text)(data)
        return self._byte_change(data)

    def _byte_change(self, data: bytes) -> bytes:
        return self.source.choice(self._of_bytes)(data)

    def _within_serialized(self, data: bytes) -> bytes:
        """The parts of a mesh lie packed by zlib, where a change of bytes would be noticed by its sum alone."""
        bodies = []
        for start in [found.start() for found in re.finditer(rb"\x1c\x04[\x03\x04]\0", data)]:
            try:
                bodies.append(zlib.decompressobj().decompress(data[start + 4:], LARGEST))
            except zlib.error:
                return self._byte_change(data)
        if not bodies:
            return self._byte_change(data)
        index = self.source.randrange(len(bodies))
        bodies[index] = self._byte_change(bodies[index])
        return serialized(bodies)

    def _with_sums(self, data: bytes) -> bytes:
        """A PNG's chunks with the sums that belong to them, as far as there are chunks."""
        result, at = data[:8], 8
        while at + 12 <= len(data):
            size = int.from_bytes(data[at:at + 4], "big")
            if at + 12 + size > len(data):
                break
            chunk = data[at + 4:at + 8 + size]
            result += data[at:at + 4] + chunk + zlib.crc32(chunk).to_bytes(4, "big")
            at += 12 + size
        return result + data[at:]

    def _at(self, data: bytes) -> int:
        """Heads are short, and much depends on them."""
        return self.source.randrange(min(len(data), self.source.choice((16, 128, 1 << 20))) + 1)

    def _overwrite(self, data: bytes) -> bytes:
        at, piece = self._at(data), self.source.choice((*_BYTES, self.source.randbytes(1), self.source.randbytes(4)))
        return data[:at] + piece + data[at + len(piece):]

    def _insert(self, data: bytes) -> bytes:
        at = self._at(data)
        return data[:at] + self.source.choice((*_BYTES, self.source.randbytes(3))) + data[at:]

    def _delete(self, data: bytes) -> bytes:
        at = self._at(data)
        return data[:at] + data[at + self.source.choice((1, 1, 2, 4, 16, 100)):]

    def _copy(self, data: bytes) -> bytes:
        start, at = self._at(data), self._at(data)
        piece = data[start:start + self.source.choice((1, 4, 16, 200))]
        return data[:at] + piece * self.source.choice((1, 1, 2, 50)) + data[at:]

    def _flip(self, data: bytes) -> bytes:
        at = self._at(data)
        return data[:at] + bytes([data[at] ^ (1 << self.source.randrange(8))]) + data[at + 1:] if at < len(data) else data

    def _cut(self, data: bytes) -> bytes:
        return data[:self._at(data)]

    def _token(self, data: bytes) -> tuple[int, int]:
        tokens = list(_TOKEN.finditer(data))
        return self.source.choice(tokens).span() if tokens else (0, 0)

    def _number(self, data: bytes) -> bytes:
        numbers = list(re.finditer(rb"[+-]?\d[\d.]*(?:[eE][+-]?\d+)?", data))
        if not numbers:
            return self._word(data)
        start, end = self.source.choice(numbers).span()
        return data[:start] + self.source.choice(_NUMBERS) + data[end:]

    def _word(self, data: bytes) -> bytes:
        """By another of the importer's words, or of the file's own, which makes names meet."""
        found = list(re.finditer(rb"[A-Za-z_][\w.\-]*", data))
        if not found:
            return self._insert(data)
        start, end = self.source.choice(found).span()
        own = self.source.random() < 0.5
        return data[:start] + (self.source.choice(found)[0] if own else self.source.choice(self._words)) + data[end:]

    def _drop_token(self, data: bytes) -> bytes:
        start, end = self._token(data)
        return data[:start] + data[end:]

    def _repeat_token(self, data: bytes) -> bytes:
        start, end = self._token(data)
        return data[:end] + (b" " + data[start:end]) * self.source.choice((1, 1, 3, 1000)) + data[end:]

    def _swap_tokens(self, data: bytes) -> bytes:
        first, second = sorted((self._token(data), self._token(data)))
        if first[1] > second[0]:
            return data
        return data[:first[0]] + data[slice(*second)] + data[first[1]:second[0]] + data[slice(*first)] + data[second[1]:]

    def _line(self, data: bytes) -> tuple[int, int]:
        lines = list(_LINE.finditer(data))
        return self.source.choice(lines).span() if lines else (0, len(data))

    def _drop_line(self, data: bytes) -> bytes:
        start, end = self._line(data)
        return data[:start] + data[end:]

    def _repeat_line(self, data: bytes) -> bytes:
        start, end = self._line(data)
        return data[:end] + data[start:end] * self.source.choice((1, 1, 2, 500)) + data[end:]

    def _move_line(self, data: bytes) -> bytes:
        start, end = self._line(data)
        rest = data[:start] + data[end:]
        at, _ = self._line(rest)
        return rest[:at] + data[start:end] + rest[at:]
