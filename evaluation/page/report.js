// The report's plots (Chart.js) and what a click on a failure opens. All texts go into the page as text, never as HTML.
(function () {
  'use strict';
  const tables = {};
  for (const table of JSON.parse(document.getElementById('report-tables').textContent).tables) {
    tables[table.id] = table.rows.map(function (row) {
      const cells = {};
      table.columns.forEach(function (column, i) { cells[column.key] = row[i]; });
      return cells;
    });
  }
  const css = getComputedStyle(document.documentElement);
  const colour = function (name) { return css.getPropertyValue('--' + name).trim(); };
  const good = colour('good'), band = colour('band'), bad = colour('bad'), third = colour('third'), soft = colour('soft');
  Chart.defaults.color = soft;
  Chart.defaults.borderColor = colour('line');
  Chart.defaults.font.family = 'system-ui, sans-serif';
  Chart.defaults.maintainAspectRatio = false;
  Chart.defaults.animation = false;
  Chart.defaults.plugins.legend.labels.usePointStyle = true;
  Chart.defaults.plugins.legend.labels.boxHeight = 7;
  Chart.defaults.elements.bar.pointStyle = 'rect';

  const column = function (id, key) { return (tables[id] || []).map(function (row) { return row[key]; }); };
  const points = function (id, x, y) {
    return (tables[id] || []).filter(function (row) { return row[x] !== null && row[y] !== null; })
      .map(function (row) { return { x: row[x], y: row[y] }; });
  };
  const title = function (text) { return { display: true, text: text }; };
  const percent = function (text) { return { min: 0, max: 100, title: title(text || '%') }; };

  function draw(id, config) {
    const canvas = document.getElementById('plot-' + id);
    if (canvas) return new Chart(canvas, config);
  }
  function line(label, data, hue, more) {
    return Object.assign({ type: 'line', label: label, data: data, borderColor: hue, backgroundColor: hue, borderWidth: 2,
      pointRadius: 0, pointHitRadius: 8, pointStyle: 'line' }, more);
  }
  /// A line with its interval as a band behind it.
  function withBand(label, id, x, y, hue) {
    return [line(label, points(id, x, y), hue),
      line('95 % from', points(id, x, 'low_pct'), band, { borderWidth: 0, fill: false }),
      line('to', points(id, x, 'high_pct'), band, { borderWidth: 0, fill: '-1', backgroundColor: band + '88' })];
  }
  const noBands = { filter: function (item) { return item.text !== '95 % from' && item.text !== 'to' && item.text !== '95 %'; } };
  /// Bars with their interval as a narrow bar over them.
  function bars(label, values, low, high, hue) {
    const between = low.map(function (from, i) { return from === null ? null : [from, high[i]]; });
    return [{ type: 'bar', label: '95 %', data: between, backgroundColor: soft, barPercentage: 0.12, grouped: false, minBarLength: 2 },
      { type: 'bar', label: label, data: values, backgroundColor: hue, barPercentage: 0.85, grouped: false }];
  }

  // Failures: a Pareto chart whose bars open their seeds.
  const isGood = function (name) { return name === 'Succeeded' || name === 'BinEmpty'; };
  const failed = (tables.outcomes || []).filter(function (row) { return !isGood(row.outcome); });
  const pictures = {};
  document.querySelectorAll('#pictures tr').forEach(function (row) {
    pictures[row.querySelector('th').textContent] = row.querySelectorAll('a');
  });
  function element(name, text, parent) {
    const made = document.createElement(name);
    if (text !== null && text !== undefined) made.textContent = text;
    if (parent) parent.appendChild(made);
    return made;
  }
  function link(seed, pick, parent) {
    const has = document.querySelector('.replay-data[data-seed="' + CSS.escape(seed) + '"]');
    if (!has) return;
    const button = element('button', 'replay', parent);
    button.addEventListener('click', function () { location.hash = 'seed-' + seed + '-pick-' + pick; });
  }
  function drill(outcome) {
    const place = document.getElementById('drill');
    place.textContent = '';
    const rows = (tables.failures || []).filter(function (row) { return row.outcome === outcome; });
    element('h3', outcome + ': ' + rows.length + (rows.length === 1 ? ' pick' : ' picks'), place);
    const scroll = element('div', null, place);
    scroll.className = 'scroll';
    const table = element('table', null, scroll);
    const head = element('tr', null, element('thead', null, table));
    ['seed', 'pick', 'reason', 'again, in the run folder', 'pictures', ''].forEach(function (text) { element('th', text, head); });
    const body = element('tbody', null, table);
    rows.forEach(function (row) {
      const line = element('tr', null, body);
      element('td', row.seed, line);
      element('td', row.pick, line);
      element('td', row.reason, line);
      element('code', row.command, element('td', null, line));
      const own = element('td', null, line);
      (pictures['artifacts/seed-' + row.seed] || []).forEach(function (a) {
        if (Number(a.textContent.slice(0, 2)) !== row.pick) return;
        const copy = element('a', a.textContent.replace('.png', ''), own);
        copy.setAttribute('href', a.getAttribute('href'));
        element('span', ' ', own);
      });
      link(row.seed, row.pick, element('td', null, line));
    });
    document.querySelectorAll('#outcomes button').forEach(function (button) {
      button.setAttribute('aria-pressed', String(button.dataset.outcome === outcome));
    });
  }
  if (document.getElementById('outcomes')) {
    failed.forEach(function (row) {
      const button = element('button', row.outcome + ' ' + row.picks, document.getElementById('outcomes'));
      button.dataset.outcome = row.outcome;
      button.setAttribute('aria-pressed', 'false');
      button.title = row.meaning;
      button.addEventListener('click', function () { drill(row.outcome); });
    });
    const all = failed.reduce(function (sum, row) { return sum + row.picks; }, 0);
    let so_far = 0;
    draw('pareto', { data: { labels: failed.map(function (row) { return row.outcome; }), datasets: [
      line('share of all failures so far, %', failed.map(function (row) { so_far += row.picks; return 100 * so_far / all; }), soft,
        { yAxisID: 'share', pointStyle: 'circle', pointRadius: 3 }),
      { type: 'bar', label: 'failed picks (click a bar for its seeds)', data: failed.map(function (row) { return row.picks; }),
        backgroundColor: bad, maxBarThickness: 70 }] },
      options: { onClick: function (event, items, chart) {
        const hit = chart.getElementsAtEventForMode(event, 'index', { intersect: false }, true);
        if (hit.length) drill(failed[hit[0].index].outcome);
      },
      onHover: function (event, items) { event.native.target.style.cursor = items.length ? 'pointer' : 'default'; },
      scales: { y: { beginAtZero: true, grace: '8%', ticks: { precision: 0 }, title: title('picks') },
        share: { position: 'right', min: 0, max: 108, ticks: { callback: function (value) { return value <= 100 ? value : ''; } }, grid: { drawOnChartArea: false }, title: title('%') } } } });
  }

  // Recall.
  draw('threshold', { data: { datasets: withBand('recall', 'recall_by_threshold', 'threshold_d', 'recall_pct', good).concat(
    [line('right: 0.1', [{ x: 0.1, y: 0 }, { x: 0.1, y: 100 }], soft, { borderDash: [4, 4], borderWidth: 1 })]) },
    options: { plugins: { legend: { labels: noBands } },
      scales: { x: { type: 'linear', min: 0, max: 0.2, title: title('MSSD below, diameters') }, y: percent('recall, %') } } });
  draw('threshold-mm', { data: { datasets: [line('recall', points('recall_by_threshold', 'threshold_mm', 'recall_mm_pct'), good),
    line('2 mm', [{ x: 2, y: 0 }, { x: 2, y: 100 }], soft, { borderDash: [4, 4], borderWidth: 1 })] },
    options: { scales: { x: { type: 'linear', min: 0, max: 10, title: title('MSSD below, mm') }, y: percent('recall, %') } } });
  draw('visibility', { data: {
    labels: (tables.recall_by_visibility || []).map(function (row) { return row.visible_from_pct + '-' + row.visible_to_pct; }),
    datasets: bars('recall', column('recall_by_visibility', 'recall_pct'), column('recall_by_visibility', 'low_pct'),
      column('recall_by_visibility', 'high_pct'), good) },
    options: { plugins: { legend: { labels: noBands }, tooltip: { callbacks: { afterBody: function (items) {
      const row = tables.recall_by_visibility[items[0].dataIndex];
      return row.found + ' of ' + row.instances + ' instances'; } } } },
      scales: { x: { title: title('visible, %') }, y: percent('recall, %') } } });
  draw('rank', { data: { labels: column('recall_by_rank', 'rank'),
    datasets: [line('at least half visible', column('recall_by_rank', 'recall_visible_pct'), third, { pointStyle: 'circle', pointRadius: 3, borderWidth: 1.5 })].concat(
      bars('all parts', column('recall_by_rank', 'recall_pct'), column('recall_by_rank', 'low_pct'),
        column('recall_by_rank', 'high_pct'), good)) },
    options: { plugins: { legend: { labels: noBands } },
      scales: { x: { title: title('rank from above; 12: and deeper') }, y: percent('recall, %') } } });

  // Errors.
  function cdf(id, key, label, unit) {
    const rows = tables.error_cdf || [];
    if (!rows.length) return;
    const at = function (p) { return rows[p][key]; };
    const end = Math.max(1e-6, 1.3 * at(95));
    draw(id, { data: { datasets: [line(label, points('error_cdf', key, 'share_pct'), good),
      line('median ' + at(50).toFixed(2) + ' ' + unit, [{ x: at(50), y: 0 }, { x: at(50), y: 50 }], third, { borderDash: [4, 4] }),
      line('95 %: ' + at(95).toFixed(2) + ' ' + unit, [{ x: at(95), y: 0 }, { x: at(95), y: 95 }], bad, { borderDash: [2, 3] })] },
      options: { scales: { x: { type: 'linear', min: 0, max: end, title: title(label + ', ' + unit),
        ticks: { callback: function (value) { return Number(value.toPrecision(2)); } } }, y: percent('poses, %') } } });
  }
  cdf('translation', 'translation_mm', 'translation error', 'mm');
  cdf('rotation', 'rotation_deg', 'rotation error', 'deg');
  draw('axes', { type: 'bar', data: {
    labels: (tables.errors_by_axis || []).map(function (row) { return row.axis + ', ' + row.unit; }), datasets: [
      { label: 'ours, mean', data: column('errors_by_axis', 'mean_abs'), backgroundColor: good },
      { label: 'ours, median', data: column('errors_by_axis', 'median_abs'), backgroundColor: band },
      { label: 'paper, mean of five', data: column('errors_by_axis', 'paper_mean_abs'), backgroundColor: soft }] },
    options: { scales: { y: { beginAtZero: true, title: title('|error|, mm and deg') } } } });
  draw('score', { data: { labels: (tables.score_calibration || []).map(function (row) {
    return row.score_from.toFixed(1) + '-' + row.score_to.toFixed(1); }),
    datasets: bars('right, %', column('score_calibration', 'right_pct'), column('score_calibration', 'low_pct'),
      column('score_calibration', 'high_pct'), good) },
    options: { plugins: { legend: { labels: noBands }, tooltip: { callbacks: { afterBody: function (items) {
      const row = tables.score_calibration[items[0].dataIndex];
      return row.right + ' of ' + row.estimates + ' estimates'; } } } },
      scales: { x: { title: title('score') }, y: percent('right, %') } } });

  // Times: the stages that add up to a cycle.
  const stages = (tables.stage_times || []).filter(function (row) {
    return row.stage !== 'total' && row.stage !== 'estimation, all'; });
  const hues = [good, '#e69f00', third, '#cc79a7', '#56b4e9', soft];
  draw('times', { type: 'bar', data: { labels: ['ours', 'paper'], datasets: stages.map(function (row, i) {
    return { label: row.stage, data: [row.mean_ms, row.paper_ms], backgroundColor: hues[i % hues.length], maxBarThickness: 46 }; }) },
    options: { indexAxis: 'y', scales: { x: { stacked: true, title: title('mean, ms') }, y: { stacked: true } } } });

  // How a bin empties.
  draw('emptying', { data: { datasets: [
    line('mean', points('emptying', 'attempts', 'left_mean'), good, { pointStyle: 'circle', pointRadius: 2 }),
    line('95 % from', points('emptying', 'attempts', 'left_p10'), band, { borderWidth: 0 }),
    line('10 to 90 % of piles', points('emptying', 'attempts', 'left_p90'), band, { borderWidth: 0, fill: '-1', backgroundColor: band + '88' })] },
    options: { plugins: { legend: { labels: noBands } }, scales: { x: { type: 'linear', min: 0, title: title('attempts'), ticks: { precision: 0 } },
      y: { beginAtZero: true, title: title('parts left in the bin') } } } });
  draw('left', { data: { labels: column('picks_by_parts_left', 'parts_left'),
    datasets: [line('cycle, median', column('picks_by_parts_left', 'cycle_median_s'), bad, { yAxisID: 'cycle', pointStyle: 'circle', pointRadius: 3 })].concat(
      bars('success', column('picks_by_parts_left', 'success_pct'), column('picks_by_parts_left', 'low_pct'),
        column('picks_by_parts_left', 'high_pct'), good)) },
    options: { plugins: { legend: { labels: noBands } }, scales: { x: { reverse: true, title: title('parts left') }, y: percent('success, %'),
      cycle: { position: 'right', beginAtZero: true, grid: { drawOnChartArea: false }, title: title('s, simulated') } } } });

  window.binpickReport = { drill: drill, tables: tables };
})();
