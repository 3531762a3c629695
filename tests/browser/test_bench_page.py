"""The page of a bench."""


def cards(tab):
    return tab.locator("#cards .head")


def test_outages_are_sorted_worst_first_and_by_time(visit):
    tab = visit("bench").tab
    worst = [float(text.split()[0]) for text in tab.locator("#cards .figure b").all_inner_texts()]
    assert len(worst) > 5
    assert worst == sorted(worst, reverse=True)
    tab.select_option("#sort", "-2")
    tab.select_option("[data-filter=r]", "1")
    starts = [float(text.split("\u2013")[0]) for text in tab.locator("#cards .title b").all_inner_texts()]
    assert starts == sorted(starts)


def test_an_outage_opens_to_every_systems_error_and_its_place_on_the_track(visit):
    tab = visit("bench").tab
    track = tab.locator("#map").screenshot()
    first = cards(tab).first
    assert first.get_attribute("aria-expanded") == "false"
    first.click()
    assert cards(tab).first.get_attribute("aria-expanded") == "true"
    panel = tab.locator(".panel")
    panel.locator(".u-over").first.wait_for()
    assert [
        text.split("\n")[0] for text in panel.locator(".chart.wide .legend > span").all_inner_texts()
    ] == [
        "ins",
        "constraints",
        "smoothed",
    ]
    assert panel.locator("table tr").count() == 12  # eleven scores and their head
    assert tab.locator("#map").screenshot() != track
    panel.locator(".jump").click()
    assert tab.evaluate("document.activeElement.id") == "map"
    cards(tab).first.click()
    assert panel.count() == 0


def test_the_cursor_of_an_open_outage_is_shared_by_its_charts_and_the_track(visit):
    tab = visit("bench").tab
    cards(tab).first.click()
    plot = tab.locator(".panel .plot").first
    plot.locator(".u-over").wait_for()
    box = plot.locator(".u-over").bounding_box()
    tab.mouse.move(box["x"] + box["width"] / 2, box["y"] + 20)
    assert "s without GNSS" in tab.inner_text("#now")
    age = float(tab.inner_text("#now").split(", ")[1].split(" ")[0])
    assert abs(age - 30.0) < 1.0  # the middle of 60 s
    lefts = tab.evaluate(
        """[...document.querySelectorAll('.panel .plot')].filter(p => p.plot.u).map(p =>
           p.querySelector('.u-cursor-x').getBoundingClientRect().left
           - p.querySelector('.u-over').getBoundingClientRect().left - p.plot.u.over.clientWidth / 2)"""
    )
    assert len(lefts) >= 2
    assert max(map(abs, lefts)) < 6  # px: one second of 60 is 8 px or more


def test_a_system_that_is_switched_off_leaves_every_part(visit):
    tab = visit("bench").tab
    cards(tab).first.click()
    toggle = tab.locator("[data-system=ins]")
    assert toggle.get_attribute("aria-pressed") == "true"
    assert tab.locator("#board-table tbody tr").count() == 3
    toggle.click()
    assert toggle.get_attribute("aria-pressed") == "false"
    assert tab.locator("#board-table tbody tr").count() == 2
    assert "ins" not in tab.locator(".panel .legend").first.inner_text().split()
    assert "ins" not in tab.inner_text("#key").split()
    for name in ("constraints", "smoothed"):
        tab.locator(f"[data-system={name}]").click()
    assert tab.locator("#board-table tbody tr").count() == 1  # the last one stays


def test_length_protocol_and_recording_choose_what_is_shown(visit):
    tab = visit("bench").tab
    median = tab.inner_text("#board-table tbody tr:last-child .measure b >> nth=0")
    tab.get_by_role("button", name="10 s", exact=True).click()
    assert tab.inner_text("#board-table tbody tr:last-child .measure b >> nth=0") != median
    tab.get_by_role("button", name="isolated").click()
    tab.select_option("[data-filter=r]", "2")
    assert "kestrel-avenue" not in tab.inner_text("#cards")
    assert tab.inner_text("#key").startswith("harbour-loop")


def test_what_looks_ahead_says_so(visit):
    tab = visit("bench").tab
    for row in tab.locator("#board-table tbody tr").all_inner_texts():
        assert ("looks ahead" in row) == ("smoothed" in row)


def test_the_list_is_walked_and_opened_by_keys_alone(visit):
    tab = visit("bench").tab
    cards(tab).first.focus()
    tab.keyboard.press("ArrowDown")
    tab.keyboard.press("ArrowDown")
    tab.keyboard.press("Enter")
    assert cards(tab).nth(2).get_attribute("aria-expanded") == "true"
    assert tab.evaluate("document.activeElement.dataset.outage") == cards(tab).nth(2).get_attribute(
        "data-outage"
    )
    tab.locator(".panel .plot").first.focus()
    tab.keyboard.press("End")
    assert "60.0 s without GNSS" in tab.inner_text("#now")


def test_decisions_biases_and_checks_are_told(visit):
    tab = visit("bench").tab
    assert "clock offset, position" in tab.inner_text("#details").lower()
    tab.select_option("[data-choice=system]", "2")
    assert "Gyro bias, forward" in tab.inner_text("#details")
    assert "held in 28 outages" in tab.inner_text("#prefix")
    assert "before motion + 30 s" in tab.inner_text("#apart")


def test_a_bench_of_one_recording_has_its_leaderboard_too(visit):
    tab = visit("one").tab
    assert tab.locator("#board-table tbody tr").count() == 3
    assert tab.locator("#pairs-table tbody tr").count() == 2
    assert cards(tab).count() == 4  # every 180 s from 240 s, in 900 s
    assert tab.locator("[data-filter=r]").count() == 0
