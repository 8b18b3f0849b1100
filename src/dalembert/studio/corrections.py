"""What NiceGUI's elements lack for screen readers and keyboards."""

from nicegui import ui

_SCRIPT = """
<script>
addEventListener("DOMContentLoaded", () => {
    const correct = () => {
        // Entries of a menu are children of the list: what is between may not take the focus.
        for (const one of document.querySelectorAll("[role=listbox] > [tabindex]")) one.removeAttribute("tabindex");
        for (const one of document.querySelectorAll(".js-plotly-plot")) if (!fitted.has(one)) {
            fitted.add(one);
            sizes.observe(one);
        }
    };
    // NiceGUI fits figures that a tab has taken out of the page, too, which is an error.
    const fitted = new WeakSet();
    const sizes = new ResizeObserver(async (entries) => {
        const { Plotly } = await import("nicegui-plotly");
        for (const { target } of entries) if (target.offsetParent && target._fullLayout) Plotly.Plots.resize(target);
    });
    addEventListener("keydown", (event) => {
        const entries = [...(event.target.closest?.("[role=menu]")?.querySelectorAll("[role=menuitem]") ?? [])];
        const at = entries.indexOf(document.activeElement), last = entries.length - 1;
        const below = at < last ? at + 1 : 0, above = at > 0 ? at - 1 : last;
        const next = { ArrowDown: below, ArrowUp: above, Home: 0, End: last }[event.key];
        if (next === undefined || last < 0) return;
        event.preventDefault();
        entries[next].focus();
    });
    new MutationObserver(correct).observe(document.body, { childList: true, subtree: true });
});
</script>
"""


def add_corrections() -> None:
    """Correct the elements of a page when they appear."""
    ui.add_head_html(_SCRIPT)
