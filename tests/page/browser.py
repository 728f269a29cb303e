"""A real Chromium, headless, driven over the W3C WebDriver protocol with Python's standard library alone.

Skips (exit code 77) where chromium or chromedriver is absent; tools/setup --all installs them.
"""
import base64
import json
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request

SKIPPED = 77  # as CTest's SKIP_RETURN_CODE has it


class Browser:
    """One window. What it logged and asked for is kept from the start."""

    def __init__(self, width=1280, height=900, webgl=True):
        if not shutil.which("chromium") or not shutil.which("chromedriver"):
            print("skipped: chromium or chromedriver is not installed (tools/setup --all)")
            sys.exit(SKIPPED)
        self.profile = tempfile.mkdtemp(prefix="binpick-browser-")
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self.port = probe.getsockname()[1]
        self.driver = subprocess.Popen(["chromedriver", f"--port={self.port}"], stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
        arguments = ["--headless=new", "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking",
                     "--disable-component-update", "--disable-sync", f"--user-data-dir={self.profile}",
                     f"--window-size={width},{height}", "--force-prefers-reduced-motion"]
        arguments += (["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] if webgl
                      else ["--disable-gpu", "--disable-3d-apis"])
        capabilities = {"browserName": "chrome", "goog:chromeOptions": {"binary": shutil.which("chromium"), "args": arguments},
                        "goog:loggingPrefs": {"browser": "ALL", "performance": "ALL"}}
        self.session = None
        for _ in range(100):
            try:
                answer = self.call("POST", "/session", {"capabilities": {"alwaysMatch": capabilities}})
                self.session = answer["sessionId"]
                break
            except urllib.error.URLError as error:
                if hasattr(error, "read"):
                    raise RuntimeError(error.read().decode()) from error
                time.sleep(0.1)
        if self.session is None:
            raise RuntimeError("chromedriver does not answer")
        self.logged, self.requested = [], []
        self.do("POST", "/url", {"url": "about:blank"})
        self.requests()  # those of the browser's own first page
        self.requested = []

    def call(self, method, path, body=None):
        data = json.dumps(body).encode() if body is not None else None
        request = urllib.request.Request(f"http://127.0.0.1:{self.port}{path}", data=data, method=method,
                                         headers={"Content-Type": "application/json"})
        with urllib.request.urlopen(request, timeout=120) as answer:
            return json.load(answer)["value"]

    def do(self, method, path, body=None):
        return self.call(method, f"/session/{self.session}{path}", body)

    def open(self, path, hash=""):
        self.do("POST", "/url", {"url": "file://" + os.path.abspath(path) + hash})

    def run(self, script, *arguments):
        """What the page's script returns."""
        return self.do("POST", "/execute/sync", {"script": script, "args": list(arguments)})

    def screenshot(self, path):
        with open(path, "wb") as file:
            file.write(base64.b64decode(self.do("GET", "/screenshot")))

    def keys(self, text):
        """To whatever has the focus."""
        actions = [{"type": step, "value": c} for c in text for step in ("keyDown", "keyUp")]
        self.do("POST", "/actions", {"actions": [{"type": "key", "id": "keyboard", "actions": actions}]})

    def click_at(self, x, y):
        self.do("POST", "/actions", {"actions": [{"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"},
                "actions": [{"type": "pointerMove", "x": int(x), "y": int(y)}, {"type": "pointerDown", "button": 0},
                            {"type": "pointerUp", "button": 0}]}]})

    def console(self):
        """All that the console said so far: warnings, errors, policy violations."""
        self.logged += [entry for entry in self.do("POST", "/se/log", {"type": "browser"})]
        return self.logged

    def requests(self):
        """URLs of all requests so far."""
        for entry in self.do("POST", "/se/log", {"type": "performance"}):
            message = json.loads(entry["message"])["message"]
            if message["method"] == "Network.requestWillBeSent":
                self.requested.append(message["params"]["request"]["url"])
        return self.requested

    def close(self):
        try:
            if self.session:
                self.do("DELETE", "")
        finally:
            self.driver.terminate()
            self.driver.wait(10)
            shutil.rmtree(self.profile, ignore_errors=True)

    def __enter__(self):
        return self

    def __exit__(self, *unused):
        self.close()
