// Colours and fonts of charts: on a light page, on a dark page, and in print (SVG files, too). Also run by node.
//
// Categorical colours: told apart by people with protanopia, deuteranopia and tritanopia, contrast with the background
// of at least 3. The eighth is for nominal parameters, the ninth for the reference (reports/page/method_colours.hpp). Text: at least 4.5. Marks may name a style that has no place in a palette:
//   reference  a line that results are compared with (nominal, truth)     muted  what is only context
(function (root) {
  'use strict';

  const fonts = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif";
  const light = {
    background: '#ffffff', text: '#1c2127', muted: '#555e69', line: '#8b939d', grid: '#e9ebee',
    categories: ['#1170c8', '#e0670f', '#00694e', '#a3238b', '#6a4d00', '#0b3d5c', '#4f55d8', '#868c96', '#1c2127'],
  };
  const dark = {
    background: '#14171b', text: '#e3e7ec', muted: '#a3acb7', line: '#6f7883', grid: '#282d34',
    categories: ['#549ff0', '#e2762f', '#3a9f6e', '#f7cfe0', '#ecc230', '#62d9f7', '#a869c8', '#7d838e', '#e3e7ec'],
  };
  const print = {...light, categories: [...light.categories.slice(0, 8), '#000000'], text: '#000000', muted: '#333333', line: '#555555', grid: '#e2e2e2'};
  const colours = {light, dark, print};

  // What only a drawing can tell: whether names below a horizontal axis have to be tilted, how many entries of a legend fit side
  // by side (0: all). A chart is drawn with `firstLayout`, and once more when betterLayout() knows a better one.
  const firstLayout = {tilted: false, columns: 0};

  // The Vega-Lite configuration of a theme for a chart of `width` px.
  function config(theme, width, layout = firstLayout) {
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
      errorbar: {ticks: {size: 10, color: c.text}, rule: {strokeWidth: 1.5, color: c.text}},
      boxplot: {
        size: width < 500 ? 7 : 14, box: {fillOpacity: 0.85}, median: {color: c.background, strokeWidth: 2}, outliers: {size: 22, filled: false},
      },
      range: {
        category: c.categories, ordinal: {scheme: 'viridis'}, ramp: {scheme: 'viridis'}, heatmap: {scheme: 'viridis'},
        diverging: {scheme: 'blueorange'},
      },
      axis: {
        ...text, domainColor: c.line, tickColor: c.line, gridColor: c.grid, tickSize: 4, labelPadding: 4,
        titlePadding: 8, labelLimit: 220 * loose, titleLimit: 600 * loose,
      },
      axisXDiscrete: {labelAngle: layout.tilted ? -40 : 0},
      legend: {
        ...text, orient: 'top', titleOrient: 'left', direction: 'horizontal', columnPadding: 18,
        ...(layout.columns > 0 ? {columns: layout.columns} : {}),
        labelLimit: Math.min(260, width) * loose, symbolStrokeWidth: 2.5, symbolSize: 130, symbolOpacity: 1, offset: 10, titlePadding: 8,
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
        reference: {color: c.text, strokeWidth: 1.25, strokeDash: [5, 3]},
        reference_band: {color: c.muted, fillOpacity: 0.2},
        muted: {stroke: c.line, strokeWidth: 1, opacity: 0.8},
      },
    };
  }

  function visit(item, use) {
    use(item);
    for (const child of item.items ?? []) visit(child, use);
  }

  function labelsCollide(axis) {
    const boxes = axis.items.filter((label) => label.opacity > 0 && !label.angle).map((label) => label.bounds);
    boxes.sort((a, b) => a.x1 - b.x1);
    return boxes.some((box, k) => k > 0 && box.x1 < boxes[k - 1].x2 + 2 && Math.abs(box.y1 - boxes[k - 1].y1) < 2);
  }

  const axisRoom = 60;  // px: in a column of views legends begin where the axes end

  // How many entries of a legend that is wider than `width` fit side by side; 0 for one that fits.
  function legendColumns(legend, width) {
    let widest = 0;
    let title = 0;
    visit(legend, (mark) => {
      for (const item of mark.items ?? []) {
        if (mark.role === 'legend-label') widest = Math.max(widest, item.bounds.width());
        if (mark.role === 'legend-title') title = Math.max(title, item.bounds.width());
      }
    });
    if (widest === 0 || legend.bounds.width() <= width - axisRoom) return 0;
    return Math.max(1, Math.floor((width - title - 10) / (widest + 40)));
  }

  // A better layout than the one that `view` was drawn with, or null.
  function betterLayout(view, width, layout) {
    const better = {...layout};
    visit(view.scenegraph().root, (mark) => {
      if (!layout.tilted && mark.role === 'axis-label' && labelsCollide(mark)) better.tilted = true;
      if (layout.columns === 0 && mark.role === 'legend')
        for (const legend of mark.items) {
          const columns = legendColumns(legend, width);
          if (columns > 0) better.columns = Math.min(columns, better.columns || columns);
        }
    });
    return better.tilted === layout.tilted && better.columns === layout.columns ? null : better;
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
  root.odobenchTheme = {config, colours, firstLayout, betterLayout, choice, choose, apply, current};
  if (root.document) {  // before the first paint
    apply(choice());
    root.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => apply(choice()));
  }
})(globalThis);
