// NiceGUI's editor with completions and explanations of words, which the studio gives.
//
// It sends its whole text, with the number of the server's text that it is based on. NiceGUI's own sends changes, and takes
// the server's text at each update of any property: both lose what is typed at that moment.
//
// A text that is not saved is kept in the browser's tab, so that it is there after a reload, which NiceGUI does when the
// studio was started again or when the connection was lost for long. Leaving the page with such a text asks first.
import Editor from "dalembert-codemirror/codemirror.js";
import * as CM from "nicegui-codemirror";

const PATIENCE = 5000; // ms
const HOVER = 300; // ms
const HINT = "Tab indents. Press Escape, then Tab to leave the text. F1 explains the word at the cursor.";
const TYPED = /[\w"'.[-]$/; // after which completions are asked for while typing

const showHint = CM.StateEffect.define();
const hint = CM.StateField.define({
  create: () => null,
  update(tooltip, transaction) {
    for (const effect of transaction.effects) if (effect.is(showHint)) return effect.value;
    return transaction.docChanged || transaction.selection ? null : tooltip;
  },
  provide: (field) => CM.showTooltip.from(field),
});

// A position in characters, as Python counts them.
function characters(state, position) {
  return [...state.sliceDoc(0, position)].length;
}

// Insert a completion over what is typed, and over closing brackets that the editor has put behind it.
function apply(insert) {
  const closing = insert.match(/\]*$/)[0];
  return (view, _, from, to) => {
    const end = to + (view.state.sliceDoc(to, to + closing.length) === closing ? closing.length : 0);
    view.dispatch({
      changes: { from, to: end, insert },
      selection: { anchor: from + insert.length },
      userEvent: "input.complete",
    });
  };
}

function tooltip(pos, { label, detail, info }) {
  const create = () => {
    const dom = document.createElement("div");
    dom.className = "study-hint";
    dom.setAttribute("role", "status");
    const [name, facts, meaning] = ["b", "span", "div"].map((tag) => dom.appendChild(document.createElement(tag)));
    name.textContent = label;
    facts.textContent = detail && ` ${detail}`;
    meaning.textContent = info;
    return { dom };
  };
  return { pos, above: true, create };
}

export default {
  extends: Editor,
  props: { revision: Number, label: String, saved: String },
  computed: {
    emitting: { get: () => false, set: () => {} }, // of changes
  },
  created() {
    this.shown = this.revision;
    this.questions = new Map();
    this.asked = 0;
    this.place = `unsaved text of ${location.pathname}`;
    this.kept = sessionStorage.getItem(this.place);
  },
  mounted() {
    addEventListener("beforeunload", this.warn);
    const kept = JSON.parse(this.kept);
    if (kept && kept.text !== this.saved) this.$emit("kept", kept);
    setTimeout(() => window.socket.listeners("connect_error").unshift(this.prepareReload)); // before NiceGUI's reload
  },
  unmounted() {
    removeEventListener("beforeunload", this.warn);
  },
  watch: {
    saved() {
      this.keep();
    },
  },
  methods: {
    setupExtensions() {
      const source = [{ autocomplete: (context) => this.complete(context) }]; // the same one each time, or it is asked again
      return [
        ...Editor.methods.setupExtensions.call(this),
        hint,
        CM.EditorView.contentAttributes.of({ "aria-label": this.label, "aria-description": HINT, tabindex: "0" }),
        CM.EditorView.updateListener.of((update) => this.sendText(update)),
        CM.EditorState.languageData.of(() => source),
        CM.hoverTooltip((view, position) => this.explain(view.state, position), { hoverTime: HOVER }),
        CM.Prec.high(
          CM.keymap.of([
            { key: "F1", preventDefault: true, run: (view) => this.explainAtCursor(view) },
            { key: "Escape", run: (view) => this.hide(view) },
          ]),
        ),
      ];
    },
    setEditorValue(value) {
      if (this.revision === this.shown) return;
      this.shown = this.revision;
      this.showing = true;
      Editor.methods.setEditorValue.call(this, value);
      this.showing = false;
      this.keep();
    },
    isSaved() {
      return !this.editor || this.editor.state.doc.toString() === this.saved;
    },
    keep() {
      try {
        if (this.isSaved()) sessionStorage.removeItem(this.place);
        else {
          const text = this.editor.state.doc.toString();
          sessionStorage.setItem(this.place, JSON.stringify({ text, saved: this.saved }));
        }
      } catch (error) {
        console.warn(`The text cannot be kept in the browser: ${error}`);
      }
    },
    warn(event) {
      if (!this.isReloading && !this.isSaved()) event.preventDefault();
    },
    prepareReload(error) {
      this.isReloading = error.message === "timeout" || error.message === "Implicit handshake failed";
    },
    sendText(update) {
      if (!update.docChanged || this.showing) return;
      this.$emit("update:value", { text: update.state.doc.toString(), revision: this.shown });
      this.keep();
    },
    ask(kind, state, position) {
      const number = ++this.asked;
      return new Promise((resolve) => {
        this.questions.set(number, resolve);
        this.$emit("question", { number, kind, position: characters(state, position) });
        setTimeout(() => this.answer(number, null), PATIENCE);
      });
    },
    answer(number, reply) {
      this.questions.get(number)?.(reply);
      this.questions.delete(number);
    },
    async complete(context) {
      if (!context.explicit && !context.matchBefore(TYPED)) return null;
      const reply = await this.ask("complete", context.state, context.pos);
      if (!reply || context.aborted || !reply.options.length) return null;
      return {
        from: context.pos - reply.typed.length,
        options: reply.options.map(({ insert, info, ...shown }) => ({
          ...shown,
          info: info || undefined,
          apply: apply(insert),
        })),
        validFor: /^[\w-]*$/,
      };
    },
    async explain(state, position) {
      const reply = await this.ask("explain", state, position);
      return reply ? tooltip(position, reply) : null;
    },
    explainAtCursor(view) {
      const position = view.state.selection.main.head;
      this.explain(view.state, position).then((shown) => view.dispatch({ effects: showHint.of(shown) }));
      return true;
    },
    hide(view) {
      if (!view.state.field(hint)) return false;
      view.dispatch({ effects: showHint.of(null) });
      return true;
    },
  },
};
