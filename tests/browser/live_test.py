"""The live part of the report in headless Chromium: it draws, its pictures are lavapipe's within the bound below, every
control changes the picture to the one it names, both colour schemes can be read, and nothing is fetched or complained
of.  Usage: live_test.py WITNESS FOLDER, where WITNESS writes page and expected pictures (live_witness.cpp)."""
import base64
import json
import math
import os
import shutil
import subprocess
import sys
import unittest

# Of the pixels of a picture: at most this share further apart than `near`, and half of them by at most one step.  SwiftShader
# and lavapipe filter alike to 1e-7, but mip levels are rounded to 8 bits in the page, and where a ray grazes an edge of
# the relief the last bit of its direction decides what it hits: single pixels then differ by anything.  Measured: 1.1 %.
NEAR, FAR_SHARE = 8, 0.02

FLAGS = """--headless --no-sandbox --disable-quic --no-first-run --disable-background-networking
    --disable-component-update --disable-sync --force-device-scale-factor=1 --use-angle=swiftshader
    --enable-unsafe-swiftshader""".split()

CHROMIUM = shutil.which("chromium")
try:
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.actions.wheel_input import ScrollOrigin
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.support.ui import Select
except ImportError:
    webdriver = None

WITNESS, FOLDER = sys.argv[1:3]


def apart(rgba, rgb):
    """How far each pixel is from its twin: the largest difference of its channels."""
    return [max(abs(rgba[4 * i + c] - rgb[3 * i + c]) for c in range(3)) for i in range(len(rgb) // 3)]


def far_share(differences):
    return sum(d > NEAR for d in differences) / len(differences)


class Live(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        os.makedirs(FOLDER, exist_ok=True)
        subprocess.run([WITNESS, FOLDER], check=True)
        with open(f"{FOLDER}/cases.json", encoding="utf-8") as file:
            cls.cases = json.load(file)
        options = webdriver.ChromeOptions()
        options.binary_location = CHROMIUM
        for flag in FLAGS:
            options.add_argument(flag)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        cls.browser = webdriver.Chrome(service=Service(shutil.which("chromedriver")), options=options)
        cls.addClassCleanup(cls.browser.quit)
        cls.browser.set_script_timeout(120)
        cls.browser.set_window_size(760, 1000)
        cls.beginning = None

    def setUp(self):
        # The page is loaded once, because browsers then compile each program once, and after tests that break it.
        if self.beginning:
            self.script("intaglio.change(arguments[0])", self.beginning)
        else:
            self.load()

    def load(self):
        self.browser.get(f"file://{os.path.abspath(FOLDER)}/live.html")
        type(self).beginning = self.state()

    def tearDown(self):
        self.assertEqual([entry["message"] for entry in self.browser.get_log("browser")], [], "the console is not empty")

    # What the page answers --------------------------------------------------------------------------

    def script(self, text, *arguments):
        return self.browser.execute_script(text, *arguments)

    def wait_for(self, promise, *arguments):
        answer = self.browser.execute_async_script(
            "const done = arguments[arguments.length - 1], a = arguments;"
            f"({promise}).then(value => done({{value}}), error => done({{error: String(error)}}));", *arguments)
        self.assertNotIn("error", answer, promise)
        return answer["value"]

    def state(self):
        return self.script("return intaglio.state()")

    def shown(self):
        return self.wait_for("intaglio.shown()")

    def draw(self, state, size, samples, which):
        pictures = self.wait_for("intaglio.draw(...a)", state, size, samples, which)
        return {name: base64.b64decode(text) for name, text in pictures.items()}

    def find(self, selector):
        return self.browser.find_element(By.CSS_SELECTOR, "#live " + selector)

    def choose(self, name, value):
        self.find(f'input[name="{name}"][value="{value}"]').click()

    def changed_by(self, act, expected, same_exact=False):
        """Acts on the page; then its state is the one before with `expected`, and it shows that one's pictures."""
        state, both = self.state(), ["technique", "exact"]
        before = self.draw({}, 64, 1, both)
        act()
        self.assertStateIs({**state, **expected})
        after, shown = self.draw({}, 64, 1, both), self.shown()
        self.assertNotEqual(after["technique"], before["technique"], "the picture did not change")
        self.assertEqual(after["exact"] == before["exact"], same_exact, "whether the exact picture stayed")
        again = self.draw(self.state(), shown["size"], 4, both)
        for name in both:
            self.assertEqual(base64.b64decode(shown[name]), again[name], f"{name}: not the picture of the state")

    def assertStateIs(self, expected):
        for name, value in self.state().items():
            if isinstance(value, (int, float)):
                self.assertAlmostEqual(value, expected[name], 4, name)
            else:
                self.assertEqual(value, expected[name], name)

    # Tests ------------------------------------------------------------------------------------------

    def test_pictures_are_lavapipes(self):
        known = {}
        for case in self.cases:
            which = [name for name in ("technique", "exact") if case[name] not in known]
            pictures = self.draw(case["state"], case["size"], 1, which)
            for name, rgba in pictures.items():
                with self.subTest(picture=name, **case["state"]):
                    with open(f"{FOLDER}/{case[name]}", "rb") as file:
                        rgb = file.read()
                    known[case[name]] = rgb
                    differences = sorted(apart(rgba, rgb))
                    self.assertLessEqual(differences[len(differences) // 2], 1, "median")
                    self.assertLessEqual(far_share(differences), FAR_SHARE)
        # The bound tells techniques apart: bump mapping beside the exact picture is far beyond it.
        bump, exact = known[self.cases[0]["technique"]], known[self.cases[0]["exact"]]
        as_rgba = b"".join(bump[i:i + 3] + b"\xff" for i in range(0, len(bump), 3))
        self.assertGreater(far_share(apart(as_rgba, exact)), 4 * FAR_SHARE)

    def test_every_program_compiles(self):
        count = self.script("""const r = new intaglio.Renderer(document.createElement("canvas"), intaglio.data);
            const keys = Object.keys(intaglio.data.programs);
            keys.forEach(key => r.program(key));
            keys.forEach(key => r.use(r.program(key)));
            return keys.length;""")
        self.assertGreater(count, 100)

    def test_choices(self):
        self.changed_by(lambda: self.choose("shape", "quad"), {"shape": "quad"})
        self.changed_by(lambda: self.choose("steps", "4"), {"steps": "4"}, same_exact=True)
        self.changed_by(lambda: self.choose("shadow", "march"), {"shadow": "march"})
        self.changed_by(lambda: self.choose("map", "cobbles"), {"map": "cobbles"})
        self.changed_by(lambda: Select(self.find("select")).select_by_value("parallax"),
                        {"technique": "parallax", "steps": ""}, same_exact=True)
        self.changed_by(lambda: Select(self.find("select")).select_by_value("relief"),
                        {"technique": "relief", "steps": "15"}, same_exact=True)
        self.changed_by(lambda: self.find('input[name="depth"]').send_keys(Keys.ARROW_RIGHT), {"depth": 0.09})
        self.choose("amplify", "16")  # of the same pictures
        ticks = [tick.text for tick in self.browser.find_elements(By.CSS_SELECTOR, "[data-tick]")]
        self.assertEqual(ticks, ["0", "8", "≥ 16 of 255"])

    def test_orbit(self):
        self.script("intaglio.change({shape: 'quad'})")
        view, pane = self.state(), self.find('[data-pane="exact"]')
        degrees = 180 / pane.rect["width"]
        pull = ActionChains(self.browser, duration=0).move_to_element(pane).click_and_hold().move_by_offset(40, 10).release()
        self.changed_by(pull.perform, {"azimuth": view["azimuth"] - 40 * degrees,
                                       "elevation": view["elevation"] + 10 * degrees})
        turn = (ActionChains(self.browser, duration=0).move_to_element(pane).key_down(Keys.SHIFT).click_and_hold()
                .move_by_offset(30, 0).release().key_up(Keys.SHIFT))
        self.changed_by(turn.perform, {"lightAzimuth": view["lightAzimuth"] + 30 * degrees})
        stage = self.find(".live-stage")
        self.changed_by(lambda: stage.send_keys(Keys.ARROW_UP), {"elevation": self.state()["elevation"] + 5})
        self.changed_by(lambda: self.find('[data-act="closer"]').click(), {"zoom": view["zoom"] / 1.2})
        self.changed_by(lambda: self.pinch(pane, 20, 40), {"zoom": self.state()["zoom"] / 2})
        turned = ActionChains(self.browser).scroll_from_origin(ScrollOrigin.from_element(pane), 0, 50)
        stage.send_keys("")  # the wheel is the page's own until a picture has the focus
        self.changed_by(turned.perform, {"zoom": self.state()["zoom"] * math.exp(0.1)})
        self.changed_by(lambda: self.find('[data-act="reset"]').click(),
                        {name: view[name] for name in ("azimuth", "elevation", "zoom")})

    def pinch(self, pane, first, last):
        """Two fingers beside the middle of a pane, from `first` pixels on either side to `last`."""
        box = self.script("const b = arguments[0].getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]", pane)
        for kind, spread in (("touchStart", first), ("touchMove", last), ("touchEnd", None)):
            points = [] if spread is None else [{"x": box[0] + side * spread, "y": box[1], "id": side + 1} for side in (-1, 1)]
            self.browser.execute_cdp_cmd("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    def test_keyboard_reaches_every_control(self):
        self.script("document.activeElement.blur(); document.querySelector('h2').tabIndex = -1; document.querySelector('h2').focus()")
        reached = []
        while len(reached) < 40:
            ActionChains(self.browser).send_keys(Keys.TAB).perform()
            name = self.script("const e = document.activeElement;"
                               "return e === document.body ? '' : e.name || e.className || e.dataset.act || e.localName")
            if not name:
                break
            reached.append(name)
        self.assertEqual(reached, ["technique", "steps", "shadow", "map", "shape", "live-stage", "depth",
                                   "lightElevation", "lightAzimuth", "amplify", "closer", "farther", "reset", "summary"])

    def test_both_schemes_show_the_pictures(self):
        papers = {}
        for scheme in ("light", "dark"):
            self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia",
                                         {"features": [{"name": "prefers-color-scheme", "value": scheme}]})
            self.shown()
            # A screenshot decoded by the page: brightness of the middle of each pane, and of the page's corner.
            seen = self.wait_for("""(async () => {
                const image = await createImageBitmap(await (await fetch("data:image/png;base64," + a[0])).blob());
                const plane = new OffscreenCanvas(image.width, image.height).getContext("2d", {willReadFrequently: true});
                plane.drawImage(image, 0, 0);
                const levels = (x, y, w, h) => {
                    const bytes = plane.getImageData(x, y, w, h).data, all = [];
                    for (let i = 0; i < bytes.length; i += 4) all.push((bytes[i] + bytes[i + 1] + bytes[i + 2]) / 3);
                    return all;
                };
                const panes = [...document.querySelectorAll("[data-pane]")].map(p => p.getBoundingClientRect());
                return {paper: levels(2, 2, 1, 1)[0],
                        panes: panes.map(b => levels(b.x + b.width / 8, b.y + b.height / 8, b.width * .75, b.height * .75))};
                })()""", self.browser.get_screenshot_as_base64())
            papers[scheme] = seen["paper"]
            for pane in seen["panes"]:
                self.assertGreater(max(pane) - min(pane), 60, f"a pane is blank in the {scheme} scheme")
            for name, ink, paper in (("text", "--ink", "--paper"), ("captions", "--soft", "--paper"),
                                     ("controls", "--ink", "--panel"), ("chosen", "--on-accent", "--accent")):
                self.assertGreaterEqual(self.contrast(ink, paper), 4.5, f"{name} in the {scheme} scheme")
        self.assertGreater(papers["light"], 230)
        self.assertLess(papers["dark"], 40)

    def contrast(self, ink, paper):
        """Of two colours of the style, as WCAG 2 defines it."""
        def luminance(colour):
            digits = self.script("return getComputedStyle(document.getElementById('live')).getPropertyValue(arguments[0])", colour)
            channels = [int(digits.strip()[i:i + 2], 16) / 255 for i in (1, 3, 5)]
            linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
            return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
        dark, light = sorted((luminance(ink), luminance(paper)))
        return (light + 0.05) / (dark + 0.05)

    def test_the_page_is_whole(self):
        self.shown()
        self.assertEqual(self.script("return performance.getEntriesByType('resource').map(e => e.name)"), [])
        self.assertFalse(self.script("return document.documentElement.scrollWidth > innerWidth"), "wider than its window")
        self.find("summary").click()
        self.wait_for("new Promise(resolve => setTimeout(resolve, 100))")
        self.assertIn("-D taps=8", self.find(".live-command").text)
        self.assertEqual(self.find(".live-text").text.splitlines()[0], "#version 300 es")

    def test_a_device_that_comes_back(self):
        before = self.draw({}, 64, 1, ["technique"])
        self.script("""window.taken = document.querySelector(".live-canvas").getContext("webgl2").getExtension("WEBGL_lose_context");
            taken.loseContext();""")
        self.wait_for("new Promise(resolve => setTimeout(resolve, 200))")
        self.assertIn("graphics device", self.find(".live-message").text)
        self.script("taken.restoreContext()")
        self.wait_for("new Promise(resolve => setTimeout(resolve, 200))")
        self.assertEqual(before, self.draw({}, 64, 1, ["technique"]))
        self.assertEqual(self.find(".live-message").text, "")
        # The browser itself says that a context was lost.
        for entry in self.browser.get_log("browser"):
            self.assertIn("CONTEXT_LOST_WEBGL", entry["message"])
        self.load()

    def test_without_webgl_there_is_a_sentence(self):
        blind = self.browser.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {
            "source": "HTMLCanvasElement.prototype.getContext = () => null;"})
        self.addCleanup(self.load)
        self.addCleanup(self.browser.execute_cdp_cmd, "Page.removeScriptToEvaluateOnNewDocument", blind)
        self.browser.refresh()
        self.assertIn("no WebGL 2", self.find(".live-message").text)
        self.assertFalse(self.find(".live-stage").is_displayed())
        self.assertFalse(self.find("select").is_displayed())


if __name__ == "__main__":
    if not CHROMIUM or not shutil.which("chromedriver") or webdriver is None:
        sys.exit("error: this test needs Debian's chromium, chromium-driver and python3-selenium: scripts/packages installs them")
    unittest.main(argv=sys.argv[:1], verbosity=2)
