#!/bin/sh
# Opens a report page in headless Chromium and takes pictures of the page: as wide as a desktop screen, as narrow as a
# telephone, and printed. Usage: scripts/report-screenshot.sh [RESULTS-FOLDER [PICTURE-FOLDER]]; default: out out.
# Without a results folder the script makes one with the demo. Chromium comes from the Debian package of that name.
# Without Chromium the script prints a message and ends with 0, because a missing browser is no fault of the page.
set -eu

results=${1:-out}
pictures=${2:-$results}
pxpl5=${PXPL5:-cargo run --quiet --release --bin pxpl5 --}

skip() {
    echo "report-screenshot: skipped: $1" >&2
    exit 0
}

find_chromium() {
    for name in chromium chromium-browser google-chrome; do
        command -v "$name" && return 0
    done
    return 1
}

if ! browser=$(find_chromium); then
    command -v apt-get >/dev/null || skip "no chromium, and no apt-get to install the Debian package chromium with"
    [ "$(id -u)" = 0 ] || skip "no chromium; install it with: sudo apt-get install chromium"
    apt-get install -y -qq chromium >/dev/null 2>&1 || skip "the Debian package chromium could not be installed"
    browser=$(find_chromium) || skip "the Debian package chromium brought no browser"
fi

[ -e "$results/report.json" ] || $pxpl5 demo --quiet --out "$results"
$pxpl5 report "$results" --quiet
mkdir -p "$pictures"
page="file://$(cd "$results" && pwd)/report.html"

# The sandbox needs rights that containers do not have. It is not needed, because the page is our own.
shoot() {
    "$browser" --headless --no-sandbox --disable-gpu --hide-scrollbars "$@" "$page" >/dev/null 2>&1
}
shoot --window-size=1100,3000 --screenshot="$pictures/report-desk.png"
shoot --window-size=500,3000 --screenshot="$pictures/report-phone.png"
shoot --no-pdf-header-footer --print-to-pdf="$pictures/report.pdf"

# A page that failed to load gives a small picture of an error.
for picture in report-desk.png report-phone.png report.pdf; do
    size=$(wc -c <"$pictures/$picture")
    [ "$size" -gt 20000 ] || { echo "report-screenshot: $picture has only $size bytes" >&2; exit 1; }
    echo "$pictures/$picture"
done
