"""What NiceGUI's elements lack for screen readers."""

from nicegui import ui

_SCRIPT = """
<script>
addEventListener("DOMContentLoaded", () => {
    const correct = () => {
        // Entries of a menu are children of the list: what is between may not take the focus.
        for (const one of document.querySelectorAll("[role=listbox] > [tabindex]")) one.removeAttribute("tabindex");
    };
    new MutationObserver(correct).observe(document.body, { childList: true, subtree: true });
});
</script>
"""


def add_corrections() -> None:
    """Correct the elements of a page when they appear."""
    ui.add_head_html(_SCRIPT)
