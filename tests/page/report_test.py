"""The report in a real browser: nothing fetched, nothing on the console, names from files stay text, plots drawn, a
failure's bar opens its picks, the replay follows time, keys and clicks, with WebGL and without.

    report_test.py BINPICK SOURCE [FOLDER for screenshots]
"""
import json
import os
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from browser import Browser  # noqa: E402

HOSTILE = [
    "<script>window.hacked=1</script>", "</script><script>window.hacked=2</script>", "<img src=x onerror=window.hacked=3>",
    "\"><svg onload=window.hacked=4>", "' onmouseover='window.hacked=5", "javascript:window.hacked=6", "<!--", "-->", "]]>",
    "<![CDATA[<b>x</b>]]>", "${window.hacked=7}", "{{constructor.constructor('window.hacked=8')()}}", "`;window.hacked=9;`",
    "\\\";window.hacked=10;//", "\\u003cscript\\u003ewindow.hacked=11\\u003c/script\\u003e", "&lt;script&gt;", "&#60;script&#62;",
    "<a href=javascript:window.hacked=12>x</a>", "<iframe srcdoc='<script>parent.hacked=13</script>'>", "<base href=//evil.invalid/>",
    "<link rel=stylesheet href=//evil.invalid/x.css>", "<meta http-equiv=refresh content='0;url=//evil.invalid'>",
    "<form action=//evil.invalid><button>x</button></form>", "<object data=//evil.invalid></object>", "<style>*{display:none}</style>",
    "</style><style>body{display:none}</style>", "</title><script>window.hacked=14</script>", "</select><script>window.hacked=15</script>",
    "\u2028window.hacked=16\u2029", "\u202egnp.exe", "a\u0000b".replace("\u0000", "\x01"), "line\nbreak", "tab\there", "%3Cscript%3E",
    "../../../etc/passwd", "__proto__", "constructor", "=HYPERLINK(\"//evil.invalid\")", "\U0001f600<b>", "A" * 3000,
]
assert len(HOSTILE) == 40


def check(condition, what):
    if not condition:
        print("FAILED:", what)
        sys.exit(1)
    print("ok:", what)


def wait(value):
    """The value once it is true, or what it is after ten seconds: a loaded machine draws late."""
    for _ in range(100):
        now = value()
        if now:
            break
        time.sleep(0.1)
    return now


def make_run(binpick, source, folder):
    """Four bearings, estimates 15 mm off: picks fail. Then what is read from files is filled with hostile names."""
    scene = os.path.join(folder, "scene.yaml")
    with open(scene, "w", encoding="utf-8") as file:
        file.write(f"name: {json.dumps(HOSTILE[0] + HOSTILE[3])}\npart: {source}/assets/parts/bearing_6914/part.yaml\ncount: 4\n"
                   f"cell: {source}/assets/cells/mz07_three_cups.yaml\nsensor: {{type: ideal}}\n"
                   "estimator: {type: oracle, translation_error: 15 mm}\ntrial: {max_picks: 2}\n")
    run = os.path.join(folder, "run")
    subprocess.run([binpick, "campaign", scene, "--seeds", "3:5", "--workers", "1", "--out", run], check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    environment = os.path.join(run, "environment.json")
    with open(environment, encoding="utf-8") as file:
        values = json.load(file)
    values.update({name: name for name in HOSTILE})
    with open(environment, "w", encoding="utf-8") as file:
        json.dump(values, file)
    for k, name in enumerate(HOSTILE):
        if "/" not in name and len(name) < 200:
            open(os.path.join(run, "artifacts", "seed-3", f"{k:02d}{name}.png"), "wb").close()
    edit_json(os.path.join(run, "artifacts", "cell.json"), hostile_cell)
    for seed in (3, 4):
        edit_json(os.path.join(run, "artifacts", f"seed-{seed}", "replay.json"), hostile_replay)
    subprocess.run([binpick, "report", run], check=True, stdout=subprocess.DEVNULL)
    return os.path.join(run, "report.html")


def edit_json(path, edit):
    with open(path, encoding="utf-8") as file:
        value = json.load(file)
    edit(value)
    with open(path, "w", encoding="utf-8") as file:
        json.dump(value, file)


def hostile_cell(cell):
    cell["parts"][0]["name"] = HOSTILE[2]


def hostile_replay(replay):
    for pick in replay["picks"]:
        pick["reason"] = " ".join(HOSTILE[:10])
    for event in replay["events"]:
        if event["what"] == "look":
            event["what"] = HOSTILE[1]
    for look in replay["looks"]:
        look["rejected"] = {"count": 40, "reasons": HOSTILE, "why": list(range(40)), "estimate": [0] * 40,
                            "tip": look["rejected"]["tip"]}


DISTINCT = """
  const from = arguments[0], copy = document.createElement('canvas');
  copy.width = from.width; copy.height = from.height;
  const context = copy.getContext('2d');
  context.drawImage(from, 0, 0);
  const pixels = context.getImageData(0, 0, copy.width, copy.height).data, seen = new Set();
  for (let i = 0; i < pixels.length; i += 4 * 7) seen.add(pixels[i] << 16 | pixels[i + 1] << 8 | pixels[i + 2]);
  return seen.size;"""


def colours(browser, selector):
    return browser.run(DISTINCT.replace("arguments[0]", "document.querySelector(arguments[0])"), selector)


def state(browser):
    return browser.run("return binpickReplay.state()")


def check_quiet(browser, page):
    check(browser.console() == [], f"nothing on the console {browser.logged[:3]}")
    foreign = [url for url in browser.requests() if not url.startswith("data:") and url.split("#")[0] != "file://" + page]
    check(foreign == [], f"nothing is asked for but the page itself {foreign[:3]}")


def check_names(browser):
    check(browser.run("return window.hacked === undefined"), "no script of a name has run")
    check(browser.run("return [...document.querySelectorAll('*')].every(e => [...e.attributes].every(a => !a.name.startsWith('on')))"),
          "no element has a handler from a name")
    check(browser.run("return document.querySelectorAll('iframe,object,embed,base,link,form,meta[http-equiv=refresh]').length") == 0,
          "no element from a name")
    shown = browser.run("return [...document.querySelectorAll('#provenance code')].map(e => e.textContent)")
    plain = ["".join(" " if ord(c) < 32 else c for c in name) for name in HOSTILE]
    check([name for name in plain if name not in shown] == [], "all 40 names stand there as text")
    links = browser.run("return [...document.querySelectorAll('#pictures a')].map(a => a.href)")
    check(len(links) > 20 and all(link.startswith("file:///") for link in links), "links lead to files of the run")


def check_failures(browser):
    rows = browser.run("return binpickReport.tables.failures.length")
    check(rows > 0, "there are failures to look at")
    browser.run("document.getElementById('plot-pareto').scrollIntoView({block: 'center'})")
    spot = browser.run("""const chart = Chart.getChart('plot-pareto'), bar = chart.getDatasetMeta(1).data[0],
      area = chart.canvas.getBoundingClientRect(); return [area.left + bar.x, area.top + (bar.y + bar.base) / 2]""")
    browser.click_at(*spot)
    first = browser.run("return binpickReport.tables.outcomes.filter(o => o.outcome !== 'Succeeded')[0]")
    opened = wait(lambda: browser.run("return document.querySelectorAll('#drill tbody tr').length"))
    check(opened == first["picks"], f"a bar opens its picks: {opened} of {first['picks']}")
    check("--seed" in browser.run("return document.getElementById('drill').textContent"), "with their replay commands")
    seed = browser.run("return document.querySelector('#drill tbody td').textContent")
    browser.run("document.querySelector('#drill button').click()")
    pick = int(browser.run("return document.querySelectorAll('#drill tbody td')[1].textContent"))
    check(wait(lambda: state(browser)["seed"] == seed and state(browser)["look"] == pick), "a failure opens its replay")


def check_replay(browser, folder):
    check(colours(browser, "#replay-canvas canvas") > 50, "the picture shows something")
    before = state(browser)["now"]
    browser.run("""const slider = document.getElementById('replay-time'); slider.value = 6;
      slider.dispatchEvent(new Event('input'))""")
    check(abs(state(browser)["now"] - 6) < 0.02 and before != 6, "scrubbing moves time")
    browser.screenshot(os.path.join(folder, "replay.png"))
    check(os.path.getsize(os.path.join(folder, "replay.png")) > 20000, "a screenshot is taken")
    browser.run("document.getElementById('replay-canvas').focus()")
    browser.keys("\ue014")
    check(abs(state(browser)["now"] - 6.1) < 0.02, "the right arrow steps")
    browser.keys("[")
    check(state(browser)["now"] < 6, "[ goes to the look before")
    picked = state(browser)["picked"]
    browser.keys("n")
    check(state(browser)["picked"] != picked, "n takes the next estimate")
    check("MSSD" in browser.run("return document.getElementById('replay-side').textContent"), "whose errors stand beside")
    for key in "aepctr":
        browser.keys(key)
    browser.keys(" ")
    start = state(browser)["now"]
    check(wait(lambda: state(browser)["now"] > start + 0.2), "space plays")
    browser.keys(" ")
    check(browser.run("""const area = document.getElementById('replay-canvas').getBoundingClientRect(), seen = [];
      return [area.left, area.top, area.width, area.height]""")[2] > 300, "the picture has its place")


def check_policy(browser):
    browser.run("""const script = document.createElement('script'); script.textContent = 'window.hacked = 99';
      document.body.appendChild(script);""")
    check(browser.run("return window.hacked === undefined"), "the policy runs no script but the page's own")


def main():
    binpick, source = sys.argv[1:3]
    with tempfile.TemporaryDirectory() as folder, Browser() as browser:
        page = make_run(binpick, source, folder)
        pictures = sys.argv[3] if len(sys.argv) > 3 else folder
        browser.open(page)
        check_names(browser)
        plots = browser.run("return [...document.querySelectorAll('canvas[id^=plot]')].map(c => c.id)")
        check(len(plots) >= 10, f"{len(plots)} plots")
        check(all(colours(browser, "#" + plot) > 3 for plot in plots), "every plot shows something")
        check_failures(browser)
        check_replay(browser, pictures)
        check_quiet(browser, page)
        check_policy(browser)
        with Browser(webgl=False) as plain:
            plain.open(page)
            check(state(plain)["webgl"] is False, "without WebGL")
            plain.run("binpickReplay.seek(6)")
            check("Pick 0" in plain.run("return document.getElementById('replay-side').textContent"), "the text follows the time")
            check(not [entry for entry in plain.console() if entry["level"] == "SEVERE"], "and nothing breaks")


if __name__ == "__main__":
    main()
