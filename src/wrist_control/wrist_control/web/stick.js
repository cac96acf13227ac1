// The stick: a pad for p and q, a slide for r, keys and a gamepad; and a button that flies.
//
// While any of them is held, the page renews its lease 30 times a second, also where nothing moves:
// each time with the newest beat that it has heard of the server. Whatever takes the page away
// from the person in front of it (blur, hide, close) lets go; what is then still pressed counts
// only when it is let go and pressed anew.

const EVERY = 33; // ms between renewals
const KEYS = {
  KeyD: [1, 0, 0], KeyA: [-1, 0, 0],
  KeyW: [0, 1, 0], KeyS: [0, -1, 0],
  KeyQ: [0, 0, 1], KeyE: [0, 0, -1],
};
const DEADMAN = 5; // the right shoulder button of the standard gamepad
const DEADZONE = 0.08;

const clamp = (value) => Math.max(-1, Math.min(1, value));
const outside = (value) => (Math.abs(value) < DEADZONE ? 0 : value);
const writes = (element) =>
  element && (element.isContentEditable || ["INPUT", "TEXTAREA", "SELECT"].includes(element.tagName));

export default {
  template: `
    <div class="stick" :class="{held: held && !refused, refused: refused}">
      <div class="pad" ref="pad" role="application" aria-label="Stick: left and right is p, up and down is q"
           @pointerdown="take($event, 'pad')" @pointermove="move" @pointerup="drop" @pointercancel="drop"
           @lostpointercapture="drop" @contextmenu.prevent>
        <span class="axis up">q +</span><span class="axis down">q −</span>
        <span class="axis left">p −</span><span class="axis right">p +</span>
        <span class="cross"></span>
        <span class="knob" :style="{left: 50 + 38 * shown[0] + '%', top: 50 - 38 * shown[1] + '%'}"></span>
      </div>
      <div class="slide" ref="slide" role="application" aria-label="Slide: left is r plus, right is r minus"
           @pointerdown="take($event, 'slide')" @pointermove="move" @pointerup="drop" @pointercancel="drop"
           @lostpointercapture="drop" @contextmenu.prevent>
        <span class="axis left">r +</span><span class="axis right">r −</span>
        <span class="knob" :style="{left: 50 - 42 * shown[2] + '%', top: '50%'}"></span>
      </div>
      <button class="fly" type="button"
           @pointerdown="take($event, 'fly')" @pointerup="drop" @pointercancel="drop"
           @lostpointercapture="drop" @contextmenu.prevent>Hold to fly</button>
    </div>`,
  props: { maneuver: String },
  data() {
    return { grip: 0, held: false, refused: false, shown: [0, 0, 0] };
  },
  created() {
    this.beatHeard = -1;
    this.pointers = new Map(); // pointer id -> {part, pqr}
    this.keys = new Set();
    this.padIsFree = true; // the gamepad's deadman button was seen open since it last let go
  },
  mounted() {
    this.listeners = [
      [window, "keydown", this.keyDown],
      [window, "keyup", (event) => { this.keys.delete(event.code); this.renew(); }],
      [window, "blur", this.letGo],
      [window, "pagehide", this.letGo],
      [document, "visibilitychange", () => { if (document.hidden) this.letGo(); }],
      [window, "contextmenu", this.letGo],
    ];
    for (const [target, name, handler] of this.listeners) target.addEventListener(name, handler);
    this.timer = setInterval(this.renew, EVERY);
  },
  beforeUnmount() {
    clearInterval(this.timer);
    this.letGo();
    for (const [target, name, handler] of this.listeners) target.removeEventListener(name, handler);
  },
  methods: {
    beat(time) {
      this.beatHeard = time;
    },
    // The server does not follow this grip: nothing that is pressed counts until it is let go.
    refuse(grip) {
      if (grip === this.grip && this.held) this.refused = true;
    },
    take(event, part) {
      event.preventDefault();
      if (event.button !== 0) return;
      event.currentTarget.setPointerCapture(event.pointerId);
      this.pointers.set(event.pointerId, { part, pqr: [0, 0, 0] });
      this.move(event);
      this.renew();
    },
    move(event) {
      const pointer = this.pointers.get(event.pointerId);
      if (!pointer || pointer.part === "fly") return;
      const box = this.$refs[pointer.part].getBoundingClientRect();
      const x = (event.clientX - box.left - box.width / 2) / (0.38 * box.width);
      const y = (event.clientY - box.top - box.height / 2) / (0.38 * box.height);
      if (pointer.part === "pad") {
        const length = Math.max(1, Math.hypot(x, y));
        pointer.pqr = [outside(x / length), outside(-y / length), 0];
      } else {
        pointer.pqr = [0, 0, outside(clamp(-x))];
      }
    },
    drop(event) {
      if (this.pointers.delete(event.pointerId)) this.renew();
    },
    keyDown(event) {
      if (writes(event.target) || event.ctrlKey || event.altKey || event.metaKey) return;
      if (event.code === "Space" || event.code === "Escape") {
        event.preventDefault();
        this.letGo();
        window.stopEverything();
      } else if (event.code in KEYS && !event.repeat) {
        this.keys.add(event.code);
        this.renew();
      }
    },
    gamepad() {
      for (const pad of navigator.getGamepads?.() ?? []) {
        if (!pad || pad.mapping !== "standard") continue;
        if (!pad.buttons[DEADMAN].pressed) {
          this.padIsFree = true;
        } else if (this.padIsFree) {
          return [outside(pad.axes[0]), outside(-pad.axes[1]), outside(-pad.axes[2])];
        }
      }
      return null;
    },
    letGo() {
      this.pointers.clear();
      this.keys.clear();
      this.padIsFree = false;
      this.renew();
    },
    renew() {
      const parts = [...this.pointers.values()];
      const pad = this.gamepad();
      const held = parts.length > 0 || this.keys.size > 0 || pad !== null;
      if (held && !this.held) {
        this.grip += 1;
        this.refused = false;
      }
      const was = this.held;
      this.held = held;
      if (!held) {
        this.refused = false;
        this.shown = [0, 0, 0];
        if (was) this.$emit("drop");
        return;
      }
      const all = [...parts.map((part) => part.pqr), ...[...this.keys].map((key) => KEYS[key]), pad ?? [0, 0, 0]];
      const pqr = [0, 1, 2].map((axis) => clamp(all.reduce((sum, one) => sum + one[axis], 0)));
      this.shown = this.refused ? [0, 0, 0] : pqr;
      // What cannot be sent now shall not be sent later.
      if (this.refused || !window.socket?.connected) return;
      const fly = parts.some((part) => part.part === "fly") ? this.maneuver : "";
      this.$emit("hold", { grip: this.grip, beat: this.beatHeard, pqr, fly });
    },
  },
};
