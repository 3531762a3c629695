"""The page of one run."""


def over(tab, index):
    plot = tab.locator(".plot").nth(index)
    plot.scroll_into_view_if_needed()
    plot.locator(".u-over").wait_for()
    return plot, plot.locator(".u-over").bounding_box()


def test_the_time_cursor_is_shared_by_charts_track_and_slider(visit):
    tab = visit("fuse").tab
    track = tab.locator("#map").screenshot()
    _, box = over(tab, 0)
    tab.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 20)
    at = float(tab.input_value("#time"))
    low, high = (float(tab.get_attribute("#time", name)) for name in ("min", "max"))
    # The middle of the chart is the middle of the drive, to one pixel.
    assert abs(at - (low + high) / 2) < (high - low) / box["width"] * 1.5
    lines = tab.evaluate(
        """[...document.querySelectorAll('.plot')].filter(p => p.plot.u).map(p =>
           p.querySelector('.u-cursor-x').getBoundingClientRect().left
           - p.querySelector('.u-over').getBoundingClientRect().left - p.plot.u.over.clientWidth / 2)"""
    )
    assert len(lines) > 2
    assert max(map(abs, lines)) < 2.5  # px: in the middle of every chart
    assert tab.locator(".chart .legend b").first.inner_text() != ""
    assert tab.locator("#map").screenshot() != track


def test_pointing_at_the_track_moves_the_cursor(visit):
    tab = visit("fuse").tab
    box = tab.locator("#map").bounding_box()
    times = set()
    for k in range(30):
        tab.mouse.move(box["x"] + box["width"] * (0.3 + 0.4 * k / 30), box["y"] + box["height"] * 0.5)
        times.add(tab.inner_text("#now"))
    assert len(times) > 2


def test_dragging_zooms_all_charts_and_escape_shows_all(visit):
    tab = visit("fuse").tab
    plot, box = over(tab, 0)
    extent = (
        "(i => { const x = document.querySelectorAll('.plot')[i].plot.u.scales.x; return [x.min, x.max]; })"
    )
    whole = tab.evaluate(f"{extent}(0)")
    tab.mouse.move(box["x"] + 0.2 * box["width"], box["y"] + 30)
    tab.mouse.down()
    tab.mouse.move(box["x"] + 0.4 * box["width"], box["y"] + 30, steps=4)
    tab.mouse.up()
    tab.wait_for_selector("#reset:not([hidden])")
    zoomed = tab.evaluate(f"{extent}(0)")
    assert zoomed[1] - zoomed[0] < 0.25 * (whole[1] - whole[0])
    assert tab.evaluate(f"{extent}(1)") == zoomed
    plot.focus()
    tab.keyboard.press("Escape")
    assert tab.evaluate(f"{extent}(0)") == whole
    assert tab.is_hidden("#reset")


def test_keys_move_the_cursor_and_zoom(visit):
    tab = visit("fuse").tab
    plot, _ = over(tab, 0)
    plot.focus()
    tab.keyboard.press("Home")
    first = float(tab.input_value("#time"))
    for _ in range(3):
        tab.keyboard.press("ArrowRight")
    assert float(tab.input_value("#time")) > first
    tab.keyboard.press("+")
    assert tab.is_visible("#reset")


def test_a_numbered_outage_is_shown_on_track_and_charts(visit):
    tab = visit("fuse").tab
    before = tab.locator("#map").screenshot()
    tab.locator("[data-from]").nth(1).click()
    assert tab.is_visible("#reset")
    assert 420.0 < float(tab.input_value("#time")) < 480.0  # the second outage of the made-up drive
    tab.wait_for_timeout(700)  # the page scrolls there smoothly
    assert tab.locator("#map").screenshot() != before
