"""What somebody must know before reading a number of the page: failed runs first, then what is flagged."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import Any, Iterator

from analysis.report import number
from analysis.report.sweep import Row, Sweep
from analysis.report.table import slope_is_off, total


@dataclass(frozen=True)
class Finding:
    level: str            # "failed", "flagged" or "noted"
    text: str             # one sentence or two
    details: list[str] = field(default_factory=list)


def _many(count: int, unit: str) -> str:
    return f"{count} {unit}" if count == 1 else f"{count} {unit}s"


def _of(part: int, whole: int) -> str:
    return f"{part} of {_many(whole, 'run')}"


def _are(count: int) -> str:
    return "is" if count == 1 else "are"


def _unfinished(sweep: Sweep) -> Iterator[Finding]:
    planned = sweep.planned
    status = {row["run"]: row["status"] for row in sweep.summary}
    states = Counter(status.get(str(run.get("run")), "") for run in planned)
    failed = [row for row in sweep.summary if row["status"] == "failed"]
    if failed:
        yield Finding("failed", f"{_of(len(failed), len(planned))} failed; no table and no curve has them.",
                      [f"{row['run']}: {row['reason'] or 'no reason was recorded'}" for row in failed])
    partial = [row for row in sweep.summary if row["status"] == "partial"]
    if partial:
        yield Finding("failed", f"{_of(len(partial), len(planned))} stopped on the way. What they have is shown where no "
                      "seed of their configuration is finished; the same command goes on from there.",
                      [f"{row['run']}: {row['frames']} frames" + (f"; {row['reason']}" if row["reason"] else "")
                       for row in partial])
    missing = [str(run.get("run")) for run in planned if str(run.get("run")) not in status]
    if missing:
        yield Finding("failed", f"{_of(len(missing), len(planned))} {_are(len(missing))} not begun.", missing)
    others = sum(count for state, count in states.items() if state not in ("finished", "failed", "partial", ""))
    if others:
        yield Finding("failed", f"{_of(others, len(planned))} {_are(others)} in none of the states finished, failed "
                      "or partial.", [f"{run}: {state}" for run, state in status.items()
                                      if state not in ("finished", "failed", "partial")])


def _verdicts(sweep: Sweep) -> Iterator[Finding]:
    odd = [row for row in sweep.summary if row.get("verdict_reason")]
    failed = [row for row in odd if row.get("verdict") == "fail"]
    for level, rows, text in (("failed", failed, "not as the config expects"),
                              ("noted", [row for row in odd if row not in failed], "judged with a remark")):
        if rows:
            yield Finding(level, f"{_of(len(rows), len(sweep.summary))} {_are(len(rows))} {text}.",
                          [f"{row['run']}: {row['verdict']}: {row['verdict_reason']}" for row in rows])


def _samples(sweep: Sweep) -> Iterator[Finding]:
    bad = [row for row in sweep.summary if row.get("non_finite") not in (None, "", "0")]
    if bad:
        details = []
        for row in bad:
            places = sweep.manifests.get(row["run"], {}).get("non_finite_samples") or []
            where = ", ".join(f"pixel {p.get('x')}, {p.get('y')} in frame {p.get('frame')}" for p in places[:4])
            more = f" and {len(places) - 4} more in its manifest" if len(places) > 4 else ""
            details.append(f"{row['run']}: {row['non_finite']}" + (f" ({where}{more})" if where else ""))
        yield Finding("flagged", f"{total(bad, 'non_finite')} samples in {_many(len(bad), 'run')} were NaN or infinite and "
                      "count as 0.", details)
    clamped = [row for row in sweep.summary if row.get("clamped_samples") not in (None, "", "0")]
    if clamped:
        yield Finding("flagged", f"{_many(len(clamped), 'run')} clamped bright samples (clamp_radiance): their images are "
                      "biased.", [f"{row['run']}: {row['clamped_samples']} samples, mean changed by "
                                  f"{number.short(row.get('clamp_bias', ''))}" for row in clamped])
    saturated = [row for row in sweep.summary if row.get("saturated_updates") not in (None, "", "0")]
    if saturated:
        yield Finding("flagged", f"{_many(len(saturated), 'run')} had table updates beyond the table's range.",
                      [f"{row['run']}: {row['saturated_updates']}" for row in saturated])


def _floor(sweep: Sweep) -> Iterator[Finding]:
    rows = [row for row in sweep.configurations if row.get("seeds_at_reference_floor") not in (None, "", "0")]
    if rows:
        yield Finding("flagged", f"{_many(len(rows), 'row')} of {len(sweep.configurations)} end at the reference's noise: there the "
                      "error is the reference's as much as the sampler's. A longer reference would tell.",
                      [f"{row['configuration']}: {row['seeds_at_reference_floor']} of {_many(int(row['seeds']), 'seed')}"
                       for row in rows])


SLOPE_CAUSES = {"steep": "steeper than −1: still learning, or rare bright samples came early",
                "flat": "flatter than −1: biased, heavy-tailed, or near the reference's noise"}


def _slope(sweep: Sweep, row: Row, name: str, label: str) -> str:
    mean, low, high = (number.short(text) for text in number.estimate(row, name))
    return f"{row['configuration']}: {label} {mean} [{low}, {high}], {SLOPE_CAUSES[slope_is_off(sweep, row, name)]}"


def _slopes(sweep: Sweep) -> Iterator[Finding]:
    names = {f"slope_{metric.name}": metric.label for metric in sweep.metrics.values() if metric.is_error}
    off = [(row, name) for row in sweep.configurations for name in names if slope_is_off(sweep, row, name)]
    if off:
        rows = len({row["configuration"] for row, _ in off})
        yield Finding("flagged", f"{_many(rows, 'row')} of {len(sweep.configurations)} {'has' if rows == 1 else 'have'} errors "
                      "that do not fall as 1/spp (log-log slope, 95 % interval).",
                      [_slope(sweep, row, name, names[name]) for row, name in off])


def _times(sweep: Sweep) -> Iterator[Finding]:
    judged = [row for row in sweep.summary if row.get("noisy")]
    noisy = [row for row in judged if row["noisy"] == "1"]
    if noisy:
        yield Finding("flagged", f"The machine was noisy in {_of(len(noisy), len(judged))}: frame times per ray spread by "
                      "more than 10 % or had more than 10 % outliers. Rather read ratios, as configurations took turns.",
                      [row["run"] for row in noisy])
    late = []
    for row in sweep.summary:
        left_out = sweep.manifests.get(row["run"], {}).get("config", {}).get("warmup_frames")
        if row.get("warmup_detected") and left_out is not None and int(row["warmup_detected"]) > left_out:
            late.append((int(row["warmup_detected"]), row["run"]))
    if late:
        yield Finding("noted", f"{_many(len(late), 'run')} had more slow frames at their start than warmup_frames leaves out "
                      f"of the medians (up to {max(late)[0]}): raise warmup_frames to that.",
                      [f"{run}: {frames} slow frames" for frames, run in sorted(late, reverse=True)])


def _references(sweep: Sweep) -> Iterator[Finding]:
    short = {}
    for manifest in sweep.manifests.values():
        reference: Any = manifest.get("reference")
        if isinstance(reference, dict) and reference.get("meets_wish") is False:
            short[reference.get("hash")] = (f"{reference.get('hash')}: {reference.get('samples')} frames, where the wish was "
                                            f"{reference.get('wish')}")
    if short:
        yield Finding("flagged", f"{_many(len(short), 'reference')} ended before the wished accuracy: raise "
                      "reference.max_frames.", list(short.values()))


def _warnings(sweep: Sweep) -> Iterator[Finding]:
    texts = [str(text) for text in sweep.manifest.get("warnings") or []]
    for manifest in sweep.manifests.values():
        texts += [str(text) for text in [*(manifest.get("warnings") or []),
                                         *((manifest.get("scene") or {}).get("warnings") or [])]]
    if texts:
        counts = Counter(texts)
        yield Finding("noted", "The program warned while it ran.",
                      [text + (f" ({count} times)" if count > 1 else "") for text, count in counts.items()])
    if sweep.gaps:
        yield Finding("flagged", "Files of this folder could not be read; what they hold is missing below.",
                      [gap.replace(f"{sweep.folder}/", "").replace(f"{sweep.folder}: ", "") for gap in sweep.gaps])


def outcome(sweep: Sweep, found: list[Finding]) -> list[tuple[str, str]]:
    """For the top of the page: levels and a few words on each."""
    done = {row["run"] for row in sweep.summary if row["status"] == "finished"}
    undone = sum(str(run.get("run")) not in done for run in sweep.planned)
    unexpected = sum(row.get("verdict") == "fail" for row in sweep.summary)
    flags, notes = (sum(finding.level == level for finding in found) for level in ("flagged", "noted"))
    words = [("failed", undone and f"{_many(undone, 'run')} not finished"), ("failed", unexpected and f"{unexpected} not as expected"),
             ("flagged", flags and _many(flags, "flag")), ("noted", notes and _many(notes, "note"))]
    return [(level, text) for level, text in words if text]


def findings(sweep: Sweep) -> list[Finding]:
    """Failures before flags before notes."""
    found = [finding for part in (_unfinished, _verdicts, _samples, _floor, _slopes, _times, _references, _warnings)
             for finding in part(sweep)]
    order = ["failed", "flagged", "noted"]
    return sorted(found, key=lambda finding: order.index(finding.level))
