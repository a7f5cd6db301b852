"""The report in a real browser: Debian's chromium, driven by Selenium.

usage: report_test.py INTAGLIO SCENE FOLDER
Measures a small scene, makes its page and opens it from its file.  Every section draws or says why not; tables and
plots hold the numbers of results.json; controls work; nothing is written to the console and nothing leaves the page.
The same numbers as a planned scene has them, each surface with views and shaders of its own, make a second page.
"""

import functools
import json
import pathlib
import shlex
import subprocess
import sys
import time
import unittest

from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import Select

intaglio, scene, folder = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
flags = ("--headless=new --no-sandbox --disable-quic --no-first-run --disable-background-networking "
         "--disable-component-update --disable-sync --use-angle=swiftshader --enable-unsafe-swiftshader")


@functools.cache
def make_page():
    folder.mkdir(parents=True, exist_ok=True)
    for command in ([intaglio, "measure", scene, "-o", str(folder)],
                    [intaglio, "report", str(folder), "-o", str(folder / "report.html"), "--picture-size", "64"]):
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return folder / "report.html", json.loads((folder / "results.json").read_text())


# Of a planned scene: a wall seen from two elevations and spikes from a third, their shaders with what is known of them.
def planned_lines(results):
    folded = {"loops": {}, "per_vertex": True, "known": ["scale = 0.08", "view.z = 0.125..0.9375"]}
    shaders = [("wall", "bricks", "parallax_occlusion", "glsl_450", {"taps": "4"}, (60, 30)),
               ("wall", "bricks", "parallax_occlusion", "ps_2_b", {"taps": "4"}, (60, 30)),
               ("thorns", "spikes", "search=relief,shadow=none", "glsl_450", {"linear_steps": "4"}, (15,)),
               ("thorns", "spikes", "search=relief,shadow=none", "hlsl_5_0", {"linear_steps": "32"}, (15,))]
    for surface, maker, composition, target, knobs, elevations in shaders:
        for case in results["cases"]:
            row = results["rows"][case["row"]]
            technique = "relief" if "relief" in composition else composition
            alike = row["surface"] == technique and row["knobs"] == knobs
            if case["map"] != maker or case["view"]["elevation"] not in elevations or not alike or \
                    (row["d3d9"] is not None) != (target == "ps_2_b"):
                continue
            yield {"schema": 1, "surface": composition, "target": target, "knobs": knobs, **folded,
                   "scene_surface": surface, "arithmetic": "fp32",
                   "map": {"name": surface, "class": surface, "width": 32, "height": 32, "bits": 16, "hash": maker,
                           "arguments": ["--maker", maker, "--map-size", "32x32"]},
                   "view": case["view"], "light": case["light"], "scale": 0.08, "size": 16, "split_size": 0,
                   "filtering": "float", "device": results["device"], "refused": None,
                   "cost": {"d3d9": row["d3d9"], "spirv": row["spirv"], "reads_mean": case["reads"]["mean"],
                            "reads_max": case["reads"]["max"], "instructions_mean": None, "instructions_max": None},
                   "hits": case["hits"], "swim": None, "picture": None, "split": None,
                   "worst": {"command": case["command"]}}


def make_planned_page(results):
    planned = folder / "planned"
    planned.mkdir(exist_ok=True)
    (planned / "results.jsonl").write_text("".join(json.dumps(line) + "\n" for line in planned_lines(results)))
    subprocess.run([intaglio, "report", str(planned), "-o", str(planned / "report.html"), "--picture-size", "64"],
                   check=True, stdout=subprocess.DEVNULL)
    return planned / "report.html"


def open_browser():
    options = webdriver.ChromeOptions()
    for flag in flags.split():
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    return webdriver.Chrome(service=webdriver.chrome.service.Service("/usr/bin/chromedriver"), options=options)


def is_close(a, b):
    return a is not None and b is not None and abs(a - b) <= 1e-12 * max(abs(a), abs(b))


class Page(unittest.TestCase):
    """What every page is asked: each class has one, in a browser of its own."""

    @classmethod
    def setUpClass(cls):
        cls.page = cls.make()
        cls.browser = open_browser()
        cls.browser.set_window_size(1400, 1000)
        cls.browser.get(cls.page.as_uri())
        cls.until("return document.documentElement.dataset.ready === 'yes'")

    @classmethod
    def tearDownClass(cls):
        cls.browser.quit()

    @classmethod
    def run_script(cls, script, *arguments):
        return cls.browser.execute_script(script, *arguments)

    # Charts follow clicks and widths a frame later.
    @classmethod
    def until(cls, script):
        for _ in range(400):
            if cls.run_script(script):
                return
            time.sleep(0.025)
        raise AssertionError(f"in vain: {script}; {cls.browser.get_log('browser')}")

    def choose(self, select_id, value):
        Select(self.browser.find_element(By.ID, select_id)).select_by_value(value)

    # Rows of a plot's table as [(variant words, map, {column: full number or words})].
    def table(self, section):
        return self.run_script("""
            const section = document.getElementById(arguments[0]), behind = section.querySelector('details.behind');
            behind.open = true;
            if (behind.children.length === 1) behind.dispatchEvent(new Event('toggle'));
            const names = [...behind.querySelectorAll('th')].map(cell => cell.textContent);
            return [...behind.querySelectorAll('tbody tr')].map(row =>
              Object.fromEntries([...row.cells].map((cell, i) => [names[i], cell.dataset.value ?? cell.textContent])));
            """, section)

    # What is drawn: [(technique, x, y)] of all points of a chart but its front.
    def points(self, section):
        return self.run_script("""
            const sets = document.getElementById(arguments[0]).querySelector('.plot').chart.data.datasets;
            return sets.filter(set => set.label !== 'Pareto front')
              .flatMap(set => set.data.map(point => [set.label, point.x, point.y]));
            """, section)

    def assert_no_sideways_scrolling(self):
        for width in (1400, 390):
            self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                         {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False})
            self.until(f"return innerWidth === {width} && document.documentElement.scrollWidth <= {width}")
        self.browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


class ReportTest(Page):
    @classmethod
    def make(cls):
        page, cls.results = make_page()
        return page

    def name_of(self, row):
        parts = [row["surface"], ", ".join(f"{name} = {value}" for name, value in row["knobs"].items()), row["target"]]
        return " · ".join(part for part in parts if part)

    def cases(self, map_name, elevation=None):
        return [case for case in self.results["cases"]
                if case["map"] == map_name and elevation in (None, case["view"]["elevation"])]

    def test_every_section_draws_or_says_why_not(self):
        sections = self.browser.find_elements(By.CSS_SELECTOR, "main > section")
        self.assertGreaterEqual(len(sections), 8)
        for section in sections:
            name = section.get_attribute("id")
            words = section.find_elements(By.CLASS_NAME, "absent")
            if words:
                self.assertGreater(len(words[0].text), 20, name)
            elif section.find_elements(By.CLASS_NAME, "plot"):
                painted = self.run_script("""
                    const canvas = arguments[0].querySelector('.plot canvas');
                    const bytes = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
                    return bytes.filter((byte, i) => i % 4 === 3 && byte > 0).length / (bytes.length / 4);
                    """, section)
                self.assertGreater(painted, 0.01, name)
        split = self.browser.find_element(By.ID, "split")
        self.assertTrue(split.find_elements(By.CLASS_NAME, "absent"), "a measurement has no error by source")

    def test_the_numbers_of_the_pareto_plot_are_the_datas(self):
        rows, measured = self.results["rows"], {}
        for case in self.cases("bricks", 30):
            measured[self.name_of(rows[case["row"]])] = case
        costs = {"reads": ("texture reads of the search and shadow (per pixel, mean)", lambda c: c["reads"]["mean"]),
                 "alu": ("SPIR-V arithmetic instructions (in the optimised shader)",
                         lambda c: rows[c["row"]]["spirv"]["alu"]),
                 "slots": ("Direct3D 9 slots (arithmetic and texture)",
                           lambda c: rows[c["row"]]["d3d9"] and
                           rows[c["row"]]["d3d9"]["arithmetic"] + rows[c["row"]]["d3d9"]["texture"]),
                 "time": ("time, as a ratio to the first variant (on the device)", lambda c: c["time"]["ratio"])}
        self.choose("pareto-error", "p95")
        for cost, (column, value_of) in costs.items():
            self.choose("pareto-cost", cost)
            table = self.table("pareto")
            expected = {name: case for name, case in measured.items() if value_of(case) is not None}
            self.assertEqual({row["Variant"] for row in table}, set(expected), cost)
            for row in table:
                case = expected[row["Variant"]]
                self.assertTrue(is_close(float(row[column]), value_of(case)), f"{cost}: {row}")
                error = float(row["hit error, 95th percentile (texels)"])
                self.assertTrue(is_close(error, case["hits"]["p95"]), f"{cost}: {row}")
                for quartile, key in (("lower", "ratio_low"), ("upper", "ratio_high")) if cost == "time" else ():
                    shown = float(row[f"{quartile} quartile of its rounds"])
                    self.assertTrue(is_close(shown, case["time"][key]), f"{quartile}: {row}")
                # On the front: nothing is at least as good in both and better in one; errors below 0.001 count alike.
                mine = (value_of(case), max(error, 0.001))
                beaten = any(other != mine and other[0] <= mine[0] and other[1] <= mine[1] for other in
                             ((value_of(c), max(c["hits"]["p95"], 0.001)) for c in expected.values()))
                if row["On the front"] == "yes":
                    self.assertFalse(beaten, f"{cost}: {row}")
            drawn = sorted(x for _, x, _ in self.points("pareto"))
            self.assertEqual(len(drawn), len(expected))
        self.choose("pareto-cost", "reads")

    def test_the_worst_of_all_is_the_greatest(self):
        self.choose("pareto-map", "worst")
        self.choose("pareto-elevation", "worst")
        for row in self.table("pareto"):
            greatest = max(case["hits"]["p95"] for case in self.results["cases"]
                           if self.name_of(self.results["rows"][case["row"]]) == row["Variant"])
            self.assertTrue(is_close(float(row["hit error, 95th percentile (texels)"]), greatest), row)
        self.choose("pareto-map", "0")
        self.choose("pareto-elevation", "30")

    def test_the_curves_are_the_datas(self):
        elevations = {case["view"]["elevation"] for case in self.results["cases"]}
        self.choose("elevation-lines", "only:relief")
        table = self.table("elevation")
        self.assertEqual(len(table), 2 * len(elevations))
        for row in table:
            case, = [case for case in self.cases("bricks", float(row["elevation of the view (degrees)"]))
                     if self.name_of(self.results["rows"][case["row"]]) == row["Variant"]]
            self.assertTrue(is_close(float(row["hit error, 95th percentile (texels)"]), case["hits"]["p95"]), row)
        self.choose("missed-map", "1")
        self.choose("missed-target", "glsl_450")
        table = self.table("missed")
        self.assertEqual({row["steps, by the knob that counts them"] for row in table}, {"4", "16", "32"})
        for row in table:
            case, = [case for case in self.cases("spikes", 30)
                     if self.name_of(self.results["rows"][case["row"]]) == row["Variant"]]
            share = 100 * case["hits"]["missed"] / case["hits"]["pixels"]
            self.assertAlmostEqual(float(row["missed first hits (% of pixels)"]), share, 9)
        self.choose("missed-map", "0")

    def test_a_technique_can_be_hidden(self):
        before = self.points("pareto")
        button = "#pareto .legend button[data-technique='relief']"
        self.browser.find_element(By.CSS_SELECTOR, button).click()
        hidden = self.points("pareto")
        self.assertEqual([point for point in before if point[0] != "relief"], hidden)
        self.assertLess(len(hidden), len(before))
        self.browser.find_element(By.CSS_SELECTOR, button).click()
        self.assertEqual(self.points("pareto"), before)

    def test_nothing_to_draw_takes_no_room(self):
        buttons = self.browser.find_elements(By.CSS_SELECTOR, "#pareto .legend button")
        names = [button.get_attribute("data-technique") for button in buttons]
        press = "document.querySelector(`#pareto .legend button[data-technique='${arguments[0]}']`).click()"
        full = self.run_script("return document.querySelector('#pareto .plot').offsetHeight")
        for name in names:
            self.run_script(press, name)
        self.assertFalse(self.browser.find_element(By.CSS_SELECTOR, "#pareto canvas").is_displayed())
        self.assertIn("No variant", self.browser.find_element(By.CSS_SELECTOR, "#pareto .absent").text)
        self.assertLess(self.run_script("return document.querySelector('#pareto .plot').offsetHeight"), full / 2)
        for name in names:
            self.run_script(press, name)
        self.assertEqual(self.run_script("return document.querySelector('#pareto .plot').offsetHeight"), full)

    def test_a_point_shows_its_command_its_picture_and_its_code(self):
        self.run_script("document.getElementById('pareto').scrollIntoView({behavior: 'instant'})")
        place = self.run_script("""
            const plot = document.querySelector('#pareto .plot'), element = plot.chart.getDatasetMeta(1).data[0];
            return [element.x - plot.clientWidth / 2, element.y - plot.clientHeight / 2];""")
        plot = self.browser.find_element(By.CSS_SELECTOR, "#pareto .plot")
        mouse = webdriver.ActionChains(self.browser)
        mouse.move_to_element_with_offset(plot, round(place[0]), round(place[1])).click().perform()
        self.until("return document.querySelector('#pareto .picked')")
        card = self.browser.find_element(By.CSS_SELECTOR, "#pareto .picked")
        self.assertIn("intaglio run parallax_occlusion", card.text)
        for button in card.find_elements(By.CSS_SELECTOR, ".controls button"):
            button.click()
        variant = self.run_script("return document.getElementById('source-variant').value")
        self.assertEqual(self.results["rows"][int(variant)]["surface"], "parallax_occlusion")

    def test_pictures_can_be_compared(self):
        pixels = "const c = document.querySelectorAll('#gallery-stage canvas')[arguments[0]];" \
                 "return c.toDataURL() + c.style.clipPath;"
        seen = set()
        for kind in ("render", "exact", "error", "reads"):
            self.choose("gallery-left", kind)
            self.until(f"return document.getElementById('gallery-stage').dataset.shown.includes('/{kind}/')")
            seen.add(self.run_script(pixels, 1))
        self.assertEqual(len(seen), 4)
        before = self.run_script(pixels, 1)
        self.run_script("""
            const slider = document.getElementById('gallery-slider');
            slider.value = 20;
            slider.dispatchEvent(new Event('input'));""")
        self.assertNotEqual(before, self.run_script(pixels, 1))
        self.assertIn("80%", self.run_script(pixels, 1))

    def test_shaders_have_their_slots_by_line(self):
        index = next(i for i, row in enumerate(self.results["rows"]) if row["target"] == "ps_2_b")
        self.choose("source-variant", str(index))
        slots = self.run_script("""
            return [...document.querySelectorAll('#source-text tr.spends')].map(row =>
              [...row.querySelectorAll('.slots')].map(cell => +cell.textContent));""")
        spent = self.results["rows"][index]["d3d9"]
        self.assertEqual([sum(line[k] for line in slots) for k in (0, 1)], [spent["arithmetic"], spent["texture"]])

    def test_shaders_say_who_spends_it(self):
        rows = """
            return [...document.querySelectorAll(`#source-spent tr.${arguments[0]}`)].map(row =>
              [...row.querySelectorAll('.slots')].map(cell => +cell.textContent));"""
        for index, row in enumerate(self.results["rows"]):
            self.choose("source-variant", str(index))
            explained = json.loads(subprocess.run(
                [intaglio, "explain", row["surface"], "-T", row["target"], "--json",
                 *(word for knob, value in row["knobs"].items() for word in ("-D", f"{knob}={value}"))],
                check=True, capture_output=True).stdout)["stages"][0]
            for kind, expected in (("step", explained["steps"]), ("spends", explained["lines"])):
                self.assertEqual(self.run_script(rows, kind),
                                 [[line["arithmetic"], line["texture"]] for line in expected], row)

    def test_schemes_and_widths(self):
        paper = "return getComputedStyle(document.body).backgroundColor"
        self.choose("theme", "dark")
        dark = self.run_script(paper)
        self.choose("theme", "light")
        self.assertNotEqual(dark, self.run_script(paper))
        self.assert_no_sideways_scrolling()

    def test_what_cannot_be_reported_is_refused_with_a_sentence(self):
        broken = folder / "broken"
        broken.mkdir(exist_ok=True)
        (broken / "results.jsonl").write_text('{"schema": 1}\n{"sch')
        page = broken / "report.html"
        for arguments, words in ((["nowhere", "-o", page], "nowhere"),
                                 ([broken, "-o", page], "results.jsonl"),
                                 ([folder], "-o FILE")):
            made = subprocess.run([intaglio, "report", *map(str, arguments)], capture_output=True, text=True, check=False)
            self.assertEqual(made.returncode, 2, made.stderr)
            self.assertIn("error: ", made.stderr)
            self.assertIn(words, made.stderr)
            self.assertFalse(page.exists())

    def test_the_same_data_gives_the_same_page(self):
        # Without pictures, so without times, which no two runs share.
        pages = [folder / "once.html", folder / "twice.html"]
        for page in pages:
            subprocess.run([intaglio, "report", str(folder), "--no-pictures", "-o", str(page)], check=True)
        once, twice = (page.read_text().replace(page.name, "") for page in pages)
        self.assertEqual(once, twice)

    def test_zz_nothing_was_complained_of_and_nothing_left_the_page(self):
        self.assertEqual(self.browser.get_log("browser"), [])
        sent = [json.loads(entry["message"])["message"] for entry in self.browser.get_log("performance")]
        addresses = {message["params"]["request"]["url"] for message in sent
                     if message["method"] == "Network.requestWillBeSent"}
        self.assertIn(self.page.as_uri(), addresses)
        self.assertEqual([address for address in addresses if not address.startswith(("file:", "data:", "blob:"))], [])


class PlannedTest(Page):
    @classmethod
    def make(cls):
        _, results = make_page()
        return make_planned_page(results)

    def offered(self, select_id):
        return [option.get_attribute("value")
                for option in self.browser.find_elements(By.CSS_SELECTOR, f"#{select_id} option")]

    def test_a_choice_offers_what_occurs_with_those_before_it(self):
        self.assertEqual(len(self.points("pareto")), 2, "it starts with something to see")
        self.assertEqual(self.offered("pareto-map"), ["0", "1", "worst"])
        views = {"thorns": ["15"], "wall": ["30", "60", "worst"]}
        targets = {"thorns": ["glsl_450", "hlsl_5_0", "worst"], "wall": ["glsl_450", "ps_2_b", "worst"]}
        self.choose("pareto-cost", "reads")
        for map_index, name in ((1, "wall"), (0, "thorns"), (1, "wall")):
            self.choose("pareto-map", str(map_index))
            self.assertEqual(self.run_script("return data.maps[arguments[0]].name", map_index), name)
            self.assertEqual(self.offered("pareto-elevation"), views[name])
            self.assertEqual(self.offered("pareto-target"), targets[name])
            for elevation in views[name]:
                if len(views[name]) > 1:  # else it is not even shown
                    self.choose("pareto-elevation", elevation)
                for target in targets[name]:
                    self.choose("pareto-target", target)
                    count = 2 if target == "worst" else 1
                    self.assertEqual(len(self.points("pareto")), count, (name, elevation, target))
        self.choose("pareto-map", "worst")
        self.assertEqual(self.offered("pareto-elevation"), ["15", "30", "60", "worst"])

    def test_a_choice_stays_where_it_still_exists(self):
        value = "return document.getElementById('pareto-target').value"
        self.choose("pareto-map", "1")
        self.choose("pareto-target", "glsl_450")
        self.choose("pareto-map", "0")
        self.assertEqual(self.run_script(value), "glsl_450")
        self.choose("pareto-target", "hlsl_5_0")
        self.choose("pareto-map", "1")
        self.assertEqual(self.run_script(value), "worst")

    def test_what_has_no_steps_is_not_offered_as_missed(self):
        self.assertEqual(self.offered("missed-map"), ["0"])
        self.assertEqual({row["steps, by the knob that counts them"] for row in self.table("missed")}, {"4", "32"})

    def test_a_name_begins_with_the_surface_and_says_what_was_asked(self):
        names = [option.text for option in self.browser.find_elements(By.CSS_SELECTOR, "#source-variant option")]
        self.assertIn("wall · ps_2_b · parallax_occlusion · taps = 4, per vertex", names)
        self.assertEqual({name.split(" · ")[0] for name in names}, {"wall", "thorns"})

    def test_a_command_gives_the_shader_that_is_shown(self):
        for index in self.offered("source-variant"):
            self.choose("source-variant", index)
            emit, explain = (code.text for code in
                             self.browser.find_elements(By.CSS_SELECTOR, "#source .command code"))
            self.assertIn("--per-vertex --fix scale=0.08 --assume view.z=0.125..0.9375", emit)
            text = subprocess.run([intaglio, *shlex.split(emit)[1:]], check=True, capture_output=True, text=True).stdout
            shown = self.run_script("""
                const cells = [...document.querySelectorAll('#source-text td.text')];
                return cells.map(cell => cell.textContent + '\\n').join('');""")
            self.assertEqual(shown, text)
            self.assertNotIn("uniform float scale", text)
            stage = json.loads(subprocess.run([intaglio, *shlex.split(explain)[1:], "--json"], check=True,
                                              capture_output=True).stdout)["stages"][0]
            spent = self.run_script("""
                return [...document.querySelectorAll('#source-spent tr.step')].map(row =>
                  [...row.querySelectorAll('.slots')].map(cell => +cell.textContent));""")
            self.assertEqual(spent, [[line["arithmetic"], line["texture"]] for line in stage["steps"]])

    def test_a_shader_is_drawn_on_its_own_surface_alone(self):
        pairs = self.run_script("""
            return data.gallery.entries.map(entry =>
              [data.maps[entry.map].name, data.variants[entry.variant].scene_surface]);""")
        self.assertEqual(sorted(pairs), [["thorns", "thorns"], ["thorns", "thorns"], ["wall", "wall"]])
        for map_index, first, count in ((1, 2, 1), (0, 0, 2)):
            self.choose("gallery-map", str(map_index))
            self.until(f"return document.getElementById('gallery-stage').dataset.shown.startsWith('{first}/')")
            self.assertEqual(len(self.browser.find_elements(By.CSS_SELECTOR, "#gallery figure")), count)
            self.assertEqual(len(self.offered("gallery-variant")), count)

    def test_widths(self):
        self.assert_no_sideways_scrolling()

    def test_zz_nothing_was_complained_of(self):
        self.assertEqual(self.browser.get_log("browser"), [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
