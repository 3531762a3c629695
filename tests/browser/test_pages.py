"""Both pages in a real browser: what every reader meets, wide and narrow, light and dark."""

import io

import numpy as np
import pytest

KINDS = ("fuse", "bench")
WIDTHS = (1440, 400)


def colours(png):
    """Number of colours in a picture, and its brightness of 255."""
    image = pytest.importorskip("matplotlib.image", reason="matplotlib reads the screenshots")
    pixels = np.round(255 * image.imread(io.BytesIO(png))[..., :3]).astype(int)
    return len(np.unique(pixels @ [65536, 256, 1])), pixels.mean()


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize("kind", KINDS)
def test_it_fits_is_drawn_and_follows_the_systems_colours(visit, kind, width, scheme):
    tab = visit(kind, width, scheme).tab
    assert tab.evaluate("document.documentElement.scrollWidth") <= width
    map_colours, _ = colours(tab.locator("#map").screenshot())
    assert map_colours > 20  # a blank canvas has one
    tab.locator(".plot").first.scroll_into_view_if_needed()
    tab.locator(".plot .u-over").first.wait_for()
    plot_colours, _ = colours(tab.locator(".plot").first.screenshot())
    assert plot_colours > 20
    _, brightness = colours(tab.screenshot())
    assert (brightness < 90) == (scheme == "dark")


@pytest.mark.parametrize("kind", KINDS)
def test_the_button_changes_light_to_dark_and_back(visit, kind):
    tab = visit(kind).tab
    paper = "getComputedStyle(document.body).backgroundColor"
    light = tab.evaluate(paper)
    tab.click("#theme")
    assert tab.evaluate(paper) != light
    assert tab.inner_text("#theme") == "Light"
    tab.click("#theme")
    assert tab.evaluate(paper) == light


@pytest.mark.parametrize("kind", KINDS)
def test_the_map_obeys_wheel_drag_and_keys(visit, kind):
    tab = visit(kind).tab
    chart = tab.locator("#map")
    chart.scroll_into_view_if_needed()
    pictures = [chart.screenshot()]

    def changed():
        tab.wait_for_timeout(60)
        pictures.append(chart.screenshot())
        return pictures[-1] != pictures[-2]

    chart.focus()
    assert changed()  # the focus ring
    for key in ("+", "ArrowLeft", "ArrowUp"):
        tab.keyboard.press(key)
        assert changed(), key
    box = chart.bounding_box()
    middle = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    tab.mouse.move(*middle)
    tab.mouse.wheel(0, -300)
    assert changed()
    tab.mouse.down()
    tab.mouse.move(middle[0] + 80, middle[1] + 40, steps=3)
    tab.mouse.up()
    assert changed()
    tab.keyboard.press("0")
    assert changed()


@pytest.mark.parametrize("kind", KINDS)
def test_it_prints_every_chart(visit, kind):
    tab = visit(kind).tab
    tab.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert tab.locator(".plot canvas").count() == tab.locator(".plot").count() > 1
    assert tab.evaluate("document.documentElement.dataset.theme") == "light"
    tab.evaluate("dispatchEvent(new Event('afterprint'))")
    assert len(tab.pdf()) > 30_000
