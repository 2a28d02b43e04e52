#!/usr/bin/env bash
# Everything one does with this project, by name: ./do help
set -euo pipefail
cd "$(dirname "$0")"
export LC_ALL=C.UTF-8

jobs=${JOBS:-$(nproc)}

say() { printf '\n== %s\n' "$*"; }

missing_packages() {
  local name
  while read -r name; do
    [ -n "$name" ] || continue
    dpkg-query -W -f='${Status}' "$name" 2>/dev/null | grep -q 'ok installed' || printf '%s\n' "$name"
  done <packages.txt
}

setup() {
  local missing=() as_root=()
  mapfile -t missing < <(missing_packages)
  [ "${#missing[@]}" -gt 0 ] || return 0
  say "Installing ${missing[*]}"
  [ "$(id -u)" -eq 0 ] || as_root=(sudo)
  "${as_root[@]}" apt-get update
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "${missing[@]}"
}

configure_and_build() {
  cmake --preset "$1" "${@:2}" >build/"$1".configure.log 2>&1 || { cat build/"$1".configure.log; return 1; }
  cmake --build --preset "$1" -j "$jobs"
}

build() {
  mkdir -p build
  say "Release build"
  configure_and_build release "$@"
}

run_tests() { ctest --preset "$1" -j "$jobs" "${@:2}"; }

sources() { git ls-files -co --exclude-standard '*.cpp' '*.h'; }

lint() {
  say "Format"
  sources | xargs clang-format --dry-run --Werror
  say "Rooms"
  python3 scripts/check_includes.py
  say "clang-tidy"
  [ -f build/release/compile_commands.json ] || build
  git ls-files -co --exclude-standard 'src/*.cpp' 'apps/*.cpp' 'python/*.cpp' |
    xargs -P "$jobs" -n 4 clang-tidy --quiet -p build/release 2> >(grep -v "warnings\? generated" >&2 || true)
}

# Leaks are off: OpenCASCADE keeps its tables until the process ends.
sanitized() {
  say "Build with the address and undefined behaviour sanitizers"
  mkdir -p build
  export ASAN_OPTIONS=detect_leaks=0:detect_stack_use_after_return=0 UBSAN_OPTIONS=print_stacktrace=1
  configure_and_build asan
  say "Tests under the sanitizers"
  # Unit tests: what spawns processes (command line, helper process, package) runs in the release build only.
  run_tests asan --exclude-regex '^(command_line|package|gates|random_bodies|gmsh_reads|meshio_reads)|Isolat|Helper|Memory'
}

test_all() {
  setup
  build -DCURVETET_BENCH=ON  # nothing runs them here, but they must compile
  say "Tests"
  run_tests release
  lint
  sanitized
}

demo() {
  setup
  build
  mkdir -p out
  local program=build/release/apps/curvetet/curvetet body
  body=$(find examples -name '*.step' | sort | head -n 1)
  say "Meshing $body"
  "$program" mesh "$body" -o out/demo.msh -o out/demo.vtu --report out/demo.json
  "$program" picture out/demo.msh -o out/demo.png --cut x=0.5
  say "Made"
  ls -1 out/demo.msh out/demo.vtu out/demo.json out/demo.png
}

bench() {
  setup
  mkdir -p build
  say "Benchmarks"
  configure_and_build bench
  find build/bench/bench -maxdepth 1 -type f -name '*_bench' -executable | sort | while read -r program; do
    say "$(basename "$program")"
    "$program"
  done
  say "Whole meshings"
  build/bench/bench/make_bodies out/bodies
  python3 scripts/benchmark.py --body out/bodies/bulk.brep --hole 0.5,0.5,0.5 --sizes 0.06,0.03,0.0149,0.0107 \
    --curvetet build/bench/apps/curvetet/curvetet --out out/benchmark --page docs/benchmarks.md
  say "Surfaces"
  python3 scripts/benchmark_surfaces.py --bodies out/bodies --curvetet build/bench/apps/curvetet/curvetet --out out/surfaces \
    --page docs/benchmarks.md
}

format() { sources | xargs clang-format -i; }

clean() { rm -rf build out; }

help() {
  cat <<'TEXT'
./do setup    install what packages.txt lists (Debian; asks for root through sudo)
./do build    Release build in build/release
./do demo     mesh the example body and draw it, into out/
./do test     build, all tests, format, room order, clang-tidy, all tests under the sanitizers
./do bench    benchmarks of the kernel, and of whole meshings beside peers (into docs/benchmarks.md)
./do format   clang-format over all sources
./do lint     format, room order and clang-tidy only
./do clean    remove build/ and out/
JOBS=n sets the number of parallel jobs.
TEXT
}

case "${1:-help}" in
  setup | build | demo | bench | format | lint | clean | help) "$1" ;;
  test) test_all ;;
  *) help; exit 2 ;;
esac
