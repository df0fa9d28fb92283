# SPDX-License-Identifier: GPL-2.0-or-later
"""report_browser.py PAGE.html SCREENSHOTS: open a report in headless Chromium as a person would, say what was seen.

Prints JSON, one entry for each of phone and desktop, light and dark: console messages, every request that is not the
page itself, the width of the page and of the window, numbers torn from their % or ± by the end of a line, the plots and the
marks in each, the colour of the background.
Speaks WebDriver with chromedriver (Debian: chromium-driver); the standard library is enough for that.
"""
import base64
import json
import pathlib
import subprocess
import sys
import tempfile
import time
import urllib.request

page, pictures = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
pictures.mkdir(parents=True, exist_ok=True)

LOOK = """
const plots = [...document.querySelectorAll('.chart')].map(box => ({
  name: box.dataset.plot, folded: box.clientWidth === 0, marks: box.querySelectorAll('svg path').length,
  words: [...box.querySelectorAll('svg text')].map(text => text.textContent)}));
const outside = [...document.querySelectorAll('main *')].filter(part => !part.closest('.wide, .chart') &&
  part.getBoundingClientRect().right > window.innerWidth + 1).map(part => part.tagName + ' ' + part.textContent.slice(0, 40));
const torn = [];
const walk = document.createTreeWalker(document.querySelector('main') || document.body, NodeFilter.SHOW_TEXT);
for (let node = walk.nextNode(); node; node = walk.nextNode()) {
  if (node.parentElement.closest('script, style, svg')) continue;
  for (const found of node.data.matchAll(/\\d[\\s\\u00a0](%|±[\\s\\u00a0]\\d)/g)) {
    const range = document.createRange();
    range.setStart(node, found.index);
    range.setEnd(node, found.index + found[0].length);
    if (range.getClientRects().length > 1) torn.push(node.data.slice(Math.max(0, found.index - 20), found.index + 20));
  }
}
return {width: document.documentElement.scrollWidth, window: window.innerWidth, plots, outside, torn,
        background: getComputedStyle(document.body).backgroundColor, headings: [...document.querySelectorAll('h2')].map(h => h.textContent),
        broken_pictures: [...document.images].filter(image => image.naturalWidth === 0).length, pictures: document.images.length};
"""


class Driver:
    def __init__(self, port):
        self.root = f"http://127.0.0.1:{port}"
        self.session = ""

    def call(self, method, path, body=None):
        request = urllib.request.Request(
            self.root + self.session + path,
            method=method,
            data=None if body is None else json.dumps(body).encode(),
            headers={"Content-Type": "application/json"},
        )
        with urllib.request.urlopen(request, timeout=300) as answer:
            return json.load(answer)["value"]

    def devtools(self, command, **parameters):
        return self.call("POST", "/goog/cdp/execute", {"cmd": command, "params": parameters})


def start_driver():
    """chromedriver on a port of its own choice, which it names on its output."""
    process = subprocess.Popen(
        ["chromedriver", "--port=0"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    )
    for line in process.stdout:
        if "started successfully on port" in line:
            return process, Driver(int(line.rstrip(".\n").split()[-1]))
    sys.exit("chromedriver did not start")


def look(driver, width, height, scheme, profile):
    options = {
        "args": [
            "--headless=new",
            "--no-sandbox",
            "--disable-gpu",
            "--disable-dev-shm-usage",
            f"--user-data-dir={profile}",
            "--disable-background-networking",
            "--disable-component-update",
            "--no-first-run",
        ]
    }
    session = driver.call(
        "POST",
        "/session",
        {
            "capabilities": {
                "alwaysMatch": {
                    "browserName": "chrome",
                    "goog:chromeOptions": options,
                    "goog:loggingPrefs": {"browser": "ALL", "performance": "ALL"},
                }
            }
        },
    )
    driver.session = "/session/" + session["sessionId"]
    try:
        driver.devtools(
            "Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 600
        )
        driver.devtools("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
        # What the browser's own first page asks for is not the report's: leave it and empty the log.
        driver.call("POST", "/url", {"url": "about:blank"})
        for log in ("browser", "performance"):
            driver.call("POST", "/se/log", {"type": log})
        driver.call("POST", "/url", {"url": page.as_uri()})
        time.sleep(1)
        seen = driver.call("POST", "/execute/sync", {"script": LOOK, "args": []})
        # What is folded is opened too, as a click does.
        driver.call(
            "POST",
            "/execute/sync",
            {"script": "for (const d of document.querySelectorAll('details')) d.open = true;", "args": []},
        )
        time.sleep(1)
        seen["opened"] = driver.call("POST", "/execute/sync", {"script": LOOK, "args": []})
        size = driver.devtools("Page.getLayoutMetrics")["cssContentSize"]
        shot = driver.devtools(
            "Page.captureScreenshot",
            format="png",
            captureBeyondViewport=True,
            clip={"x": 0, "y": 0, "width": width, "height": min(size["height"], 16000), "scale": 1},
        )
        (pictures / f"{width}_{scheme}.png").write_bytes(base64.b64decode(shot["data"]))
        seen["console"] = [entry["message"] for entry in driver.call("POST", "/se/log", {"type": "browser"})]
        events = [
            json.loads(entry["message"])["message"] for entry in driver.call("POST", "/se/log", {"type": "performance"})
        ]
        urls = [e["params"]["request"]["url"] for e in events if e["method"] == "Network.requestWillBeSent"]
        seen["requests"] = [url for url in urls if not url.startswith("data:") and url != page.as_uri()]
        seen["page_loads"] = urls.count(page.as_uri())
        return seen
    finally:
        driver.call("DELETE", "")
        driver.session = ""


process, driver = start_driver()
try:
    result = {}
    for width, height in ((390, 844), (1280, 900)):
        for scheme in ("light", "dark"):
            with tempfile.TemporaryDirectory() as profile:
                result[f"{width} {scheme}"] = look(driver, width, height, scheme, profile)
    print(json.dumps(result, indent=1))
finally:
    process.terminate()
    process.wait()
