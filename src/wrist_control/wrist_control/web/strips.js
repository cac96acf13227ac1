// Strips of the last seconds: one chart with a grid for each, fed with new samples alone.
import { echarts } from "nicegui-echart";

const GAP = 6, HEAD = 18, TOP = 8; // px
const round = (value) => Math.round(1e4 * value) / 1e4;

export default {
  template: "<div></div>",
  props: { strips: Array, seconds: Number },
  mounted() {
    this.chart = echarts.init(this.$el, null, { renderer: "canvas" });
    this.observer = new ResizeObserver(() => this.lay());
    this.observer.observe(this.$el);
    this.clear();
    this.lay();
  },
  beforeUnmount() {
    this.observer.disconnect();
    this.chart.dispose();
  },
  watch: {
    strips() { this.clear(); this.lay(); },
  },
  methods: {
    clear() {
      this.times = [];
      this.rows = [];
    },
    // Each row is a time in s and one value for each line, strip after strip.
    push(rows) {
      if (this.rows.length && rows.length && rows[0].length !== this.rows[0].length) this.clear();
      for (const row of rows) this.rows.push(row);
      if (!this.rows.length) return;
      const last = this.rows[this.rows.length - 1][0];
      while (this.rows[0][0] < last - this.seconds) this.rows.shift();
      this.draw(last);
    },
    draw(last) {
      if (document.hidden) return;
      let column = 0;
      const series = [];
      for (const strip of this.strips) {
        for (const _ of strip.lines) {
          column += 1;
          series.push({ data: this.rows.map((row) => [row[0] - last, row[column]]) });
        }
      }
      this.chart.setOption({ series });
    },
    lay() {
      const height = this.$el.clientHeight, width = this.$el.clientWidth;
      if (!height || !width || !this.strips.length) return;
      this.chart.resize();
      const style = getComputedStyle(this.$el);
      const ink = style.getPropertyValue("--ink").trim() || "#888";
      const faint = style.getPropertyValue("--line").trim() || "#8884";
      const columns = width > 620 ? 2 : 1;
      const rows = Math.ceil(this.strips.length / columns);
      const each = (height - TOP) / rows, wide = width / columns;
      const grid = [], xAxis = [], yAxis = [], series = [], title = [];
      this.strips.forEach((strip, index) => {
        const left = Math.floor(index / rows) * wide, top = TOP + (index % rows) * each;
        grid.push({ left: left + 34, top: top + HEAD, width: wide - 42, height: each - HEAD - GAP });
        title.push({ text: strip.title, left: left + 34, top: top, padding: 0,
          textStyle: { fontSize: 11, fontWeight: 500, color: ink, fontFamily: "inherit" } });
        xAxis.push({ gridIndex: index, type: "value", min: -this.seconds, max: 0, show: false });
        yAxis.push({ gridIndex: index, type: "value", min: strip.low, max: strip.high,
          interval: strip.high - strip.low, splitLine: { lineStyle: { color: faint } },
          axisLabel: { fontSize: 9, color: ink, formatter: (value) => round(value) } });
        for (const line of strip.lines) {
          series.push({ type: "line", xAxisIndex: index, yAxisIndex: index, showSymbol: false, silent: true,
            data: [], color: line.colour, animation: false,
            lineStyle: { width: line.dashed ? 1.2 : 1.8, type: line.dashed ? "dashed" : "solid" },
            markLine: line.limits && { silent: true, symbol: "none", label: { show: false }, animation: false,
              lineStyle: { color: "#e11d48", width: 1, type: "solid", opacity: 0.7 },
              data: line.limits.map((limit) => ({ yAxis: limit })) } });
        }
      });
      this.chart.setOption({ animation: false, grid, xAxis, yAxis, series, title }, { notMerge: true });
    },
  },
};
