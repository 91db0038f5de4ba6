// Colours and fonts of charts: on a light page, on a dark page, and in print (SVG files, too). Also run by node.
//
// Categorical colours: told apart by people with protanopia, deuteranopia and tritanopia, contrast with the background
// of at least 3. Text: at least 4.5. Marks may name a style that has no place in a palette:
//   reference  a line that results are compared with (nominal, truth)     muted  what is only context
(function (root) {
  'use strict';

  const fonts = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif";
  const light = {
    background: '#ffffff', text: '#1c2127', muted: '#555e69', line: '#8b939d', grid: '#e9ebee',
    categories: ['#1170c8', '#e0670f', '#00694e', '#a3238b', '#6a4d00', '#0b3d5c', '#4f55d8', '#868c96'],
  };
  const dark = {
    background: '#14171b', text: '#e3e7ec', muted: '#a3acb7', line: '#6f7883', grid: '#282d34',
    categories: ['#549ff0', '#e2762f', '#3a9f6e', '#f7cfe0', '#ecc230', '#62d9f7', '#a869c8', '#7d838e'],
  };
  const print = {...light, text: '#000000', muted: '#333333', line: '#555555', grid: '#e2e2e2'};
  const colours = {light, dark, print};

  // The Vega-Lite configuration of a theme for a chart of `width` px.
  function config(theme, width) {
    const c = colours[theme];
    const loose = theme === 'print' ? 2 : 1;  // node only guesses how wide text is
    const text = {labelColor: c.muted, titleColor: c.text, labelFontSize: 12, titleFontSize: 12, titleFontWeight: 500};
    return {
      background: theme === 'print' ? c.background : null,
      font: theme === 'print' ? "Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif" : fonts,
      padding: {left: 2, right: 8, top: 4, bottom: 2},
      aria: false,
      view: {stroke: null},
      mark: {color: c.categories[0]},
      line: {strokeWidth: 1.75, strokeJoin: 'round', strokeCap: 'round'},
      trail: {color: c.categories[0]},
      area: {fillOpacity: 0.22},
      bar: {tooltip: true},
      rect: {tooltip: true},
      point: {size: 40, filled: true, tooltip: true},
      circle: {size: 40, tooltip: true},
      square: {size: 40, tooltip: true},
      tick: {thickness: 1.5},
      rule: {color: c.text, strokeWidth: 1},
      text: {color: c.text, fontSize: 12},
      errorband: {band: {fillOpacity: 0.22}},
      errorbar: {ticks: true, rule: {strokeWidth: 1.5}},
      boxplot: {box: {fillOpacity: 0.85}, median: {color: c.background, strokeWidth: 2}, outliers: {size: 22, filled: false}},
      range: {
        category: c.categories, ordinal: {scheme: 'viridis'}, ramp: {scheme: 'viridis'}, heatmap: {scheme: 'viridis'},
        diverging: {scheme: 'blueorange'},
      },
      axis: {
        ...text, domainColor: c.line, tickColor: c.line, gridColor: c.grid, tickSize: 4, labelPadding: 4,
        titlePadding: 8, labelLimit: 220 * loose, titleLimit: 600 * loose,
      },
      legend: {
        ...text, orient: 'top', direction: 'horizontal', columns: Math.max(1, Math.floor(width / 150)), columnPadding: 18,
        labelLimit: Math.min(260, width) * loose, symbolType: 'circle', symbolStrokeWidth: 2.5, offset: 10, titlePadding: 8,
        gradientLength: Math.min(240, Math.max(120, width / 3)), gradientThickness: 10,
      },
      header: {...text, titleFontSize: 12, labelFontSize: 13, labelFontWeight: 500, labelColor: c.text, labelLimit: width * loose},
      title: {
        color: c.text, subtitleColor: c.muted, anchor: 'start', fontSize: 13, fontWeight: 600, subtitleFontSize: 12,
        offset: 8, limit: width * loose,
      },
      concat: {spacing: 24},
      facet: {spacing: 24},
      style: {
        reference: {stroke: c.text, fill: null, strokeWidth: 1.25, strokeDash: [5, 3]},
        muted: {stroke: c.line, strokeWidth: 1, opacity: 0.8},
      },
    };
  }

  // The page's own choice: 'auto', 'light' or 'dark', kept where the browser lets a file keep anything.
  const key = 'odobench-theme';
  function choice() {
    try {
      return root.localStorage.getItem(key) || 'auto';
    } catch {
      return 'auto';
    }
  }
  function current() {
    return root.document.documentElement.dataset.theme;
  }
  function apply(chosen) {
    const system = root.matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light';
    root.document.documentElement.dataset.theme = chosen === 'auto' ? system : chosen;
    root.document.dispatchEvent(new Event('odobench:theme'));
  }
  function choose(chosen) {
    try {
      root.localStorage.setItem(key, chosen);
    } catch { /* a browser that keeps nothing for files */ }
    apply(chosen);
  }
  root.odobenchTheme = {config, colours, choice, choose, apply, current};
  if (root.document) {  // before the first paint
    apply(choice());
    root.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => apply(choice()));
  }
})(globalThis);
