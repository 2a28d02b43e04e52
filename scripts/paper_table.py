#!/usr/bin/env python3
"""Counts of the default recovery and of `--recovery paper` side by side, as a Markdown table.

Reads the output folders of two runs of corpus.py over the same list (results.jsonl and the reports beside it) and
replaces what stands between the markers `<!-- counts -->` and `<!-- end of counts -->` of a page.

    scripts/paper_table.py out/default out/paper --divide 20 --page docs/paper.md
"""
import argparse
import json
import pathlib
import statistics
import sys

BEGIN, END = "<!-- counts -->", "<!-- end of counts -->"


def read(folder, divide):
    rows = {}
    for line in (folder / "results.jsonl").read_text().splitlines():
        row = json.loads(line)
        if row["divide"] != divide:
            continue
        name = pathlib.Path(row["body"]).name
        if row["status"] == "valid":
            row["report"] = json.loads((folder / f"{name}.{divide:g}.report.json").read_text())
        rows[name] = row
    return rows


def added(row, *keys):
    return sum(row["report"]["recovery"][key] for key in keys)


def short_cause(row):
    if row is None:
        return "not run"
    parts = [part.strip() for part in row["cause"].split(":")]
    return (parts[1] if len(parts) > 1 else parts[0]).split(",")[0]


def cells(row, paper):
    if row is None or row["status"] != "valid":
        return [f"no ({short_cause(row)})"] + [""] * (6 if paper else 3)
    triangles = f"{row['triangles']}"
    if not paper:
        points = added(row, "edge_splits", "stage_one_points", "stage_two_points")
        return ["yes", triangles, f"{points}", f"{row['seconds']:.1f}"]
    return ["yes", triangles, f"{added(row, 'edge_splits')}", f"{added(row, 'stage_one_points')}",
            f"{added(row, 'stage_two_points')}", f"{added(row, 'fallback_faces')}", f"{row['seconds']:.1f}"]


def table(default, paper):
    lines = ["| body | default | triangles | points added | s | paper | triangles | edges | stage one | stage two | "
             "faces that fell back | s |",
             "|---|---|--:|--:|--:|---|--:|--:|--:|--:|--:|--:|"]
    for name in sorted(set(default) | set(paper)):
        row = [name] + cells(default.get(name), False) + cells(paper.get(name), True)
        lines.append("| " + " | ".join(row) + " |")
    both = [name for name in paper if paper[name]["status"] == "valid" and default.get(name, {}).get("status") == "valid"]
    ratios = [paper[name]["triangles"] / default[name]["triangles"] for name in both]
    lines.append("")
    lines.append(f"Valid: default {sum(r['status'] == 'valid' for r in default.values())}, paper "
                 f"{sum(r['status'] == 'valid' for r in paper.values())}, of {len(set(default) | set(paper))}.")
    if ratios:
        lines.append(f"Boundary triangles of the paper's mode over the default's, {len(ratios)} bodies: median "
                     f"{statistics.median(ratios):.2f}, largest {max(ratios):.1f}.")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("default", type=pathlib.Path)
    parser.add_argument("paper", type=pathlib.Path)
    parser.add_argument("--divide", type=float, default=20)
    parser.add_argument("--page", type=pathlib.Path, help="page to change; without it the table is printed")
    arguments = parser.parse_args()
    made = table(read(arguments.default, arguments.divide), read(arguments.paper, arguments.divide))
    if not arguments.page:
        print(made)
        return
    text = arguments.page.read_text()
    if BEGIN not in text or END not in text:
        sys.exit(f"{arguments.page} has no place for the table: {BEGIN} and {END}")
    head, rest = text.split(BEGIN, 1)
    arguments.page.write_text(f"{head}{BEGIN}\n{made}\n{END}{rest.split(END, 1)[1]}")


if __name__ == "__main__":
    main()
