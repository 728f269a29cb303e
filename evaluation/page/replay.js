// The 3D replay (three.js). Frames and numbers as docs/report.md has them: W has z up, metres; quaternions x y z w.
(function () {
  'use strict';
  const place = document.getElementById('replay-canvas');
  if (!place) return;
  const side = document.getElementById('replay-side'), controlsPlace = document.getElementById('replay-controls');
  const status = document.getElementById('replay-status'), select = document.getElementById('replay-seed');
  const kPosition = 1e-4, kJoint = 2e-4, kUnit = 1 / 32767;
  const kHues = { part: 0xd8c8a4, held: 0xe69f00, right: 0x0072b2, wrong: 0xd55e00, ignored: 0x999999, chosen: 0xf0e442,
    truth: 0x009e73, rejected: 0xcc79a7, cloud: 0x30363f, bin: 0x7f8c9b, table: 0xc9cfd6, tray: 0xa9b4bf, arm: 0xd6d9dd, tool: 0x5a6470 };

  function element(name, text, parent) {
    const made = document.createElement(name);
    if (text !== null && text !== undefined) made.textContent = text;
    if (parent) parent.appendChild(made);
    return made;
  }
  function bytes(text) {
    const raw = atob(text), array = new Uint8Array(raw.length);
    for (let i = 0; i < raw.length; ++i) array[i] = raw.charCodeAt(i);
    return array.buffer;
  }
  const words = function (text) { return new Int16Array(bytes(text)); };
  const counts = function (text) { return new Uint16Array(bytes(text)); };
  const mm = function (metres) { return metres === null ? '-' : (1e3 * metres).toFixed(2); };
  const degrees = function (angle) { return angle === null ? '-' : (angle * 57.29578).toFixed(2); };

  let gl = null;  // scene, camera, renderer; null: no WebGL, the text alone
  let replay = null, now = 0, playing = false, speed = 2, picked = -1, last = 0;
  const show = { arm: true, parts: true, cloud: true, estimates: true, truth: false, rejected: false };

  // ---- scene -------------------------------------------------------------------------------------------------------
  function start() {
    const scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera(42, 1, 0.01, 20);
    const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
    scene.background = new THREE.Color(0xe9edf2);
    camera.up.set(0, 0, 1);
    scene.add(new THREE.HemisphereLight(0xffffff, 0x9aa3ad, 0.75));
    const sun = new THREE.DirectionalLight(0xffffff, 0.55);
    sun.position.set(-1, -2, 3);
    scene.add(sun);
    renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    place.appendChild(renderer.domElement);
    const orbit = new THREE.OrbitControls(camera, renderer.domElement);
    orbit.enableKeys = false;
    orbit.addEventListener('change', draw);
    return { scene: scene, camera: camera, renderer: renderer, orbit: orbit };
  }
  function geometry(mesh) {
    const raw = words(mesh.v), positions = new Float32Array(raw.length), indices = counts(mesh.i);
    for (let i = 0; i < raw.length; ++i) positions[i] = raw[i] * mesh.step;
    const indexed = new THREE.BufferGeometry();
    indexed.setAttribute('position', new THREE.BufferAttribute(positions, 3));
    indexed.setIndex(new THREE.BufferAttribute(indices, 1));
    const flat = indices.length ? indexed.toNonIndexed() : indexed;
    flat.computeVertexNormals();
    return flat;
  }
  function setPose(object, array, k) {
    object.position.set(array[7 * k] * kPosition, array[7 * k + 1] * kPosition, array[7 * k + 2] * kPosition);
    object.quaternion.set(array[7 * k + 3] * kUnit, array[7 * k + 4] * kUnit, array[7 * k + 5] * kUnit, array[7 * k + 6] * kUnit);
    object.quaternion.normalize();
  }
  function solid(shape, hue, more) {
    return new THREE.Mesh(shape, new THREE.MeshLambertMaterial(Object.assign({ color: hue, side: THREE.DoubleSide }, more)));
  }
  const cell = JSON.parse(document.getElementById('replay-cell').textContent);
  const fixed = [], joints = [];
  let partShapes = [], partEdges = [], binBox = null, trayBox = null;
  function buildCell() {
    for (const item of cell.fixed) {
      const seeThrough = item.name === 'bin' ? { transparent: true, opacity: 0.22, depthWrite: false } : {};
      const mesh = solid(geometry(item.mesh), kHues[item.name] || kHues.table, seeThrough);
      if (item.name === 'bin') mesh.renderOrder = 2;
      setPose(mesh, words(item.x), 0);
      mesh.updateMatrixWorld();
      if (item.name === 'bin') binBox = new THREE.Box3().setFromObject(mesh);
      if (item.name === 'tray') trayBox = new THREE.Box3().setFromObject(mesh);
      fixed.push(mesh);
      gl.scene.add(mesh);
    }
    const base = new THREE.Group();
    setPose(base, words(cell.base), 0);
    gl.scene.add(base);
    let parent = base;
    gl.arm = base;
    cell.links.forEach(function (link, k) {
      if (k > 0) {
        const before = new THREE.Group(), turn = new THREE.Group();
        setPose(before, words(cell.joints[k - 1].x), 0);
        parent.add(before);
        before.add(turn);
        joints.push(turn);
        parent = turn;
      }
      if (link.i.length) parent.add(solid(geometry(link), kHues.arm));
    });
    const flange = new THREE.Group();
    setPose(flange, words(cell.flange), 0);
    parent.add(flange);
    for (const item of cell.carried) {
      const mesh = solid(geometry(item.mesh), kHues.tool);
      setPose(mesh, words(item.x), 0);
      flange.add(mesh);
    }
    partShapes = cell.parts.map(function (part) { return geometry(part.mesh); });
    partEdges = partShapes.map(function (shape) { return new THREE.EdgesGeometry(shape, 40); });
  }
  /// From beyond the bin, seen from the robot, and a little off the tray's side; tray and arm in the picture.
  function home() {
    const middle = binBox.getCenter(new THREE.Vector3()), size = binBox.getSize(new THREE.Vector3());
    const tray = trayBox ? trayBox.getCenter(new THREE.Vector3()) : middle.clone();
    const out = new THREE.Vector3().subVectors(middle, gl.arm.position).setZ(0);
    if (out.length() < 1e-3) out.set(1, 0, 0);
    out.normalize();
    const aside = new THREE.Vector3(-out.y, out.x, 0);
    if (aside.dot(new THREE.Vector3().subVectors(tray, middle)) > 0) aside.negate();
    const away = 2.45 * Math.max(size.x, size.y, size.z);
    gl.orbit.target.copy(middle).lerp(tray, 0.25).setZ(middle.z + 0.04 * away);
    gl.camera.position.copy(gl.orbit.target).addScaledVector(out, 0.95 * away).addScaledVector(aside, 0.3 * away);
    gl.camera.position.z += 0.75 * away;
    gl.orbit.update();
  }

  // ---- one trial ---------------------------------------------------------------------------------------------------
  function track(data) { return { t: counts(data.t), x: words(data.x) }; }
  function decode(json) {
    const r = JSON.parse(json);
    r.bodies = r.bodies.map(track);
    r.arm = { t: counts(r.arm.t), q: words(r.arm.q) };
    r.looks.forEach(function (look) {
      look.poses = look.estimates.map(function (e) { return words(e.x); });
      look.points = words(look.cloud);
      look.tips = words(look.rejected.tip);
      look.visible = {};
      look.truth.forEach(function (pair) { look.visible[pair[0]] = pair[1]; });
    });
    return r;
  }
  /// Index of the last time <= tick, -1 before the first; and how far towards the next.
  function segment(times, tick) {
    let low = 0, high = times.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (times[middle] <= tick) low = middle + 1; else high = middle;
    }
    const k = low - 1;
    if (k < 0 || k + 1 >= times.length) return [k, 0];
    return [k, (tick - times[k]) / (times[k + 1] - times[k])];
  }
  let bodies = [], overlay = null;
  function open(seed) {
    const block = document.querySelector('.replay-data[data-seed="' + CSS.escape(seed) + '"]');
    if (!block) return false;
    select.value = seed;
    replay = decode(block.textContent);
    now = 0;
    picked = -1;
    playing = false;
    if (gl) {
      bodies.forEach(function (mesh) { gl.scene.remove(mesh); mesh.material.dispose(); });
      bodies = replay.bodies.map(function (unused, i) {
        const mesh = solid(partShapes[replay.part_of_body[i]], kHues.part);
        mesh.userData.body = i;
        gl.scene.add(mesh);
        return mesh;
      });
    }
    slider.max = String(replay.duration);
    fillPicks();
    const first = replay.looks.length ? replay.looks[0].t : 0;
    seek(first + 0.001);
    return true;
  }
  function lookAt(time) {
    let found = null;
    for (const look of replay.looks) if (look.t <= time + 1e-6) found = look;
    return found;
  }
  function eventAt(time) {
    let found = null;
    for (const event of replay.events) if (event.t <= time + 1e-6) found = event;
    return found;
  }

  // ---- what a look saw and believed ----------------------------------------------------------------------------------
  function clearOverlay() {
    if (!overlay) return;
    gl.scene.remove(overlay);
    overlay.traverse(function (object) {
      if (object.material) object.material.dispose();
      if (object.geometry && object.userData.own) object.geometry.dispose();
    });
    overlay = null;
  }
  function hueOf(look, k) {
    const e = look.estimates[k];
    return e.ignored ? kHues.ignored : e.right ? kHues.right : kHues.wrong;
  }
  function addCloud(look) {
    const positions = new Float32Array(look.points.length);
    for (let i = 0; i < positions.length; ++i) positions[i] = look.points[i] * kPosition;
    const shape = new THREE.BufferGeometry();
    shape.setAttribute('position', new THREE.BufferAttribute(positions, 3));
    const cloud = new THREE.Points(shape, new THREE.PointsMaterial({ color: kHues.cloud, size: 2, sizeAttenuation: false }));
    cloud.userData.own = true;
    overlay.add(cloud);
  }
  function addOutline(part, pose, hue, k) {
    const lines = new THREE.LineSegments(partEdges[part], new THREE.LineBasicMaterial({ color: hue, linewidth: 2 }));
    if (pose.isMatrix4) pose.decompose(lines.position, lines.quaternion, lines.scale); else setPose(lines, pose, 0);
    lines.userData.estimate = k;
    lines.renderOrder = 3;
    lines.material.depthTest = k === undefined;
    overlay.add(lines);
  }
  function addRejected(look) {
    const n = look.rejected.why.length;
    for (let k = 0; k < n; ++k) {
      const tip = new THREE.Vector3(look.tips[6 * k], look.tips[6 * k + 1], look.tips[6 * k + 2]).multiplyScalar(kPosition);
      const axis = new THREE.Vector3(look.tips[6 * k + 3], look.tips[6 * k + 4], look.tips[6 * k + 5]).normalize();
      const arrow = new THREE.ArrowHelper(axis, tip.clone().addScaledVector(axis, -0.06), 0.06, kHues.rejected, 0.015, 0.01);
      overlay.add(arrow);
    }
  }
  function buildOverlay(look) {
    clearOverlay();
    if (!look) return;
    overlay = new THREE.Group();
    if (show.cloud) addCloud(look);
    if (show.estimates) look.estimates.forEach(function (e, k) { addOutline(e.part, look.poses[k], k === picked ? kHues.chosen : hueOf(look, k), k); });
    if (show.truth) look.truth.forEach(function (pair) {
      const body = replay.bodies[pair[0]], at = segment(body.t, look.t / replay.tick)[0];
      if (at < 0) return;
      const holder = new THREE.Object3D();
      setPose(holder, body.x, at);
      holder.updateMatrix();
      addOutline(replay.part_of_body[pair[0]], holder.matrix, kHues.truth);
    });
    if (show.rejected) addRejected(look);
    gl.scene.add(overlay);
  }

  // ---- time ------------------------------------------------------------------------------------------------------------
  const from = new THREE.Quaternion(), to = new THREE.Quaternion(), a = new THREE.Object3D(), b = new THREE.Object3D();
  let shownLook = null, heldBody = -1;
  function placeBodies(tick) {
    bodies.forEach(function (mesh, i) {
      const body = replay.bodies[i], at = segment(body.t, tick);
      mesh.visible = show.parts && at[0] >= 0;
      if (at[0] < 0) return;
      setPose(a, body.x, at[0]);
      if (at[1] > 0) {
        setPose(b, body.x, at[0] + 1);
        a.position.lerp(b.position, at[1]);
        a.quaternion.slerp(b.quaternion, at[1]);
      }
      mesh.position.copy(a.position);
      mesh.quaternion.copy(a.quaternion);
      mesh.material.color.setHex(i === heldBody ? kHues.held : kHues.part);
    });
  }
  function placeArm(tick) {
    const at = segment(replay.arm.t, tick);
    gl.arm.visible = show.arm && at[0] >= 0;
    if (at[0] < 0) return;
    for (let j = 0; j < 6; ++j) {
      const q = replay.arm.q, here = q[6 * at[0] + j], next = at[1] > 0 ? q[6 * at[0] + 6 + j] : here;
      const axis = cell.joints[j].axis;
      joints[j].quaternion.setFromAxisAngle(from.set(0, 0, 0, 1) && new THREE.Vector3(axis[0], axis[1], axis[2]),
        (here + at[1] * (next - here)) * kJoint);
    }
  }
  function draw() {
    if (gl) gl.renderer.render(gl.scene, gl.camera);
  }
  function seek(time) {
    now = Math.max(0, Math.min(time, replay.duration));
    const look = lookAt(now), event = eventAt(now), tick = now / replay.tick;
    slider.value = String(now);
    clock.textContent = now.toFixed(2) + ' / ' + replay.duration.toFixed(1) + ' s';
    status.textContent = event ? (event.pick >= 0 ? 'pick ' + event.pick + ': ' : '') + event.what : 'parts are dropped';
    heldBody = -1;
    if (look && look.chosen !== null && event && (event.what === 'held' || event.what === 'lifted'))
      heldBody = look.estimates[look.chosen] ? look.estimates[look.chosen].body : -1;
    if (look !== shownLook) {
      shownLook = look;
      picked = look && look.chosen !== null ? look.chosen : -1;
      picks.value = look ? String(look.t + 0.001) : '0';
      if (gl) buildOverlay(look);
      fillSide(look);
    }
    if (!gl) return;
    placeBodies(tick);
    placeArm(tick);
    draw();
  }
  function frame(stamp) {
    if (!playing) return;
    const step = Math.min(0.1, (stamp - last) / 1000) * speed;
    last = stamp;
    seek(now + step);
    if (now >= replay.duration) play(false);
    if (playing) requestAnimationFrame(frame);
  }
  function play(on) {
    playing = on;
    playButton.textContent = on ? 'pause' : 'play';
    playButton.setAttribute('aria-pressed', String(on));
    if (on && now >= replay.duration) seek(0);
    if (on) requestAnimationFrame(function (stamp) { last = stamp; frame(stamp); });
  }

  // ---- text beside it ----------------------------------------------------------------------------------------------------
  function pickEstimate(k) {
    picked = k;
    if (gl) { buildOverlay(shownLook); draw(); }
    fillSide(shownLook);
  }
  function facts(parent, rows) {
    const body = element('tbody', null, element('table', null, parent));
    rows.forEach(function (pair) {
      const row = element('tr', null, body);
      element('th', pair[0], row);
      element('td', pair[1], row).className = 'mono';
    });
  }
  function fillSide(look) {
    side.textContent = '';
    if (!look) {
      element('p', 'Parts fall into the bin; the first look is still to come.', side);
      return;
    }
    const pick = replay.picks[look.pick];
    element('h3', 'Pick ' + look.pick + ': ' + pick.outcome, side);
    if (pick.reason) element('p', pick.reason, side);
    if (picked >= 0 && look.estimates[picked]) {
      const e = look.estimates[picked];
      element('h3', 'Estimate ' + picked + (look.chosen === picked ? ', the one to pick' : ''), side);
      facts(side, [['part', cell.parts[e.part].name], ['', e.ignored ? 'of a hidden part: counts neither way' : e.right ? 'right' : 'wrong'],
        ['score', e.score === null ? '-' : e.score.toFixed(3)], ['translation', mm(e.translation) + ' mm'],
        ['X / Y / Z', e.abs_xyz.map(mm).join(' / ') + ' mm'], ['rotation', degrees(e.rotation) + ' deg'], ['MSSD', mm(e.mssd) + ' mm'],
        ['fit rms', mm(e.fit_rms) + ' mm'],
        ['visible', e.body in look.visible ? (100 * look.visible[e.body]).toFixed(0) + ' %' : '-']]);
    } else {
      element('p', 'Click a part for its errors.', side);
    }
    element('h3', look.estimates.length + ' estimates, ' + look.truth.length + ' parts in the bin', side);
    const body = element('tbody', null, element('table', null, side));
    look.estimates.forEach(function (e, k) {
      const row = element('tr', null, body);
      row.className = k === picked ? 'picked' : '';
      const button = element('button', String(k), element('td', null, row));
      button.addEventListener('click', function () { pickEstimate(k); });
      element('span', '', element('td', null, row)).className = 'swatch ' + (e.ignored ? 'ignored' : e.right ? 'right' : 'wrong');
      element('td', e.ignored ? 'hidden' : e.right ? 'right' : 'wrong', row);
      element('td', mm(e.mssd) + ' mm', row).className = 'mono';
    });
    fillRejected(look);
  }
  function fillRejected(look) {
    if (!look.rejected.count) return;
    element('h3', look.rejected.count + ' candidates were given up', side);
    const sums = {};
    look.rejected.why.forEach(function (k) { sums[k] = (sums[k] || 0) + 1; });
    const list = element('ul', null, side);
    Object.keys(sums).sort(function (x, y) { return sums[y] - sums[x]; }).forEach(function (k) {
      element('li', sums[k] + ': ' + look.rejected.reasons[k], list);
    });
    if (look.rejected.count > look.rejected.why.length)
      element('p', 'The first ' + look.rejected.why.length + ' tried are shown.', side);
  }

  // ---- controls ------------------------------------------------------------------------------------------------------------
  const bar = element('div', null, controlsPlace);
  bar.className = 'row';
  const playButton = element('button', 'play', bar);
  const back = element('button', '-0.1 s', bar), ahead = element('button', '+0.1 s', bar);
  const slider = element('input', null, bar), clock = element('span', '', bar);
  slider.type = 'range';
  slider.id = 'replay-time';
  slider.min = '0';
  slider.step = '0.02';
  slider.setAttribute('aria-label', 'time of the trial');
  clock.className = 'mono';
  const speeds = element('select', null, element('label', 'speed', bar));
  [0.25, 0.5, 1, 2, 4, 8].forEach(function (factor) { element('option', factor + ' x', speeds).value = String(factor); });
  speeds.value = '2';
  const picks = element('select', null, element('label', 'go to', bar));
  const legend = element('div', null, controlsPlace);
  legend.className = 'row';
  const names = { parts: 'parts', arm: 'arm', cloud: 'points seen', estimates: 'estimates', truth: 'truth', rejected: 'given up' };
  const boxes = {};
  Object.keys(names).forEach(function (key) {
    const label = element('label', null, legend), box = element('input', null, label);
    box.type = 'checkbox';
    box.checked = show[key];
    boxes[key] = box;
    if (key === 'estimates') {
      element('span', '', label).className = 'swatch right';
      element('span', 'right', label);
      element('span', '', label).className = 'swatch wrong';
      element('span', 'wrong', label);
    } else {
      const hue = element('span', '', label);
      if (key !== 'parts' && key !== 'arm') hue.className = 'swatch ' + key;
      element('span', names[key], label);
    }
    box.addEventListener('change', function () {
      show[key] = box.checked;
      if (gl) buildOverlay(shownLook);
      seek(now);
    });
  });
  element('p', 'Keys, with the picture in focus: space plays, left and right step 0.1 s (shift: 1 s), [ and ] go from pick to pick, ' +
    'n takes the next estimate, h looks from the start again; a e p c t r turn layers on and off. Mouse: turn, wheel, right button moves.',
    controlsPlace).className = 'note';
  function fillPicks() {
    picks.textContent = '';
    element('option', 'drop', picks).value = '0';
    replay.looks.forEach(function (look) {
      element('option', 'pick ' + look.pick + ': ' + replay.picks[look.pick].outcome, picks).value = String(look.t + 0.001);
    });
  }
  function toPick(direction) {
    const times = [0].concat(replay.looks.map(function (look) { return look.t + 0.001; }));
    const next = direction > 0 ? times.find(function (t) { return t > now + 1e-3; })
      : times.reverse().find(function (t) { return t < now - 1e-3; });
    if (next !== undefined) seek(next);
  }
  function toggle(key) { boxes[key].click(); }
  const keys = {
    ' ': function () { play(!playing); }, ArrowLeft: function (e) { seek(now - (e.shiftKey ? 1 : 0.1)); },
    ArrowRight: function (e) { seek(now + (e.shiftKey ? 1 : 0.1)); }, '[': function () { toPick(-1); }, ']': function () { toPick(1); },
    n: function () { if (shownLook && shownLook.estimates.length) pickEstimate((picked + 1) % shownLook.estimates.length); },
    h: function () { if (gl) home(); }, a: function () { toggle('arm'); }, e: function () { toggle('estimates'); },
    p: function () { toggle('parts'); }, c: function () { toggle('cloud'); }, t: function () { toggle('truth'); }, r: function () { toggle('rejected'); }
  };
  place.addEventListener('keydown', function (event) {
    const act = keys[event.key];
    if (!act || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    act(event);
  });
  playButton.addEventListener('click', function () { play(!playing); });
  back.addEventListener('click', function () { play(false); seek(now - 0.1); });
  ahead.addEventListener('click', function () { play(false); seek(now + 0.1); });
  slider.addEventListener('input', function () { play(false); seek(Number(slider.value)); });
  speeds.addEventListener('change', function () { speed = Number(speeds.value); });
  picks.addEventListener('change', function () { play(false); seek(Number(picks.value)); });
  select.addEventListener('change', function () { open(select.value); });

  function clicked(event) {
    const area = gl.renderer.domElement.getBoundingClientRect(), ray = new THREE.Raycaster();
    ray.setFromCamera({ x: 2 * (event.clientX - area.left) / area.width - 1, y: 1 - 2 * (event.clientY - area.top) / area.height }, gl.camera);
    const hit = ray.intersectObjects(bodies.filter(function (mesh) { return mesh.visible; }))[0];
    if (!hit || !shownLook) return;
    const body = hit.object.userData.body;
    let best = -1;
    shownLook.estimates.forEach(function (e, k) {
      if (e.body === body && (best < 0 || e.mssd < shownLook.estimates[best].mssd)) best = k;
    });
    pickEstimate(best);
    if (best < 0) element('p', 'Part ' + body + ': no estimate of it. Visible: ' +
      (body in shownLook.visible ? (100 * shownLook.visible[body]).toFixed(0) + ' %' : 'not in the bin') + '.', side);
  }
  function resize() {
    if (!gl) return;
    const width = place.clientWidth, height = place.clientHeight;
    gl.renderer.setSize(width, height);
    gl.camera.aspect = width / height;
    gl.camera.updateProjectionMatrix();
    draw();
  }
  function hasWebGL() {
    const probe = document.createElement('canvas');
    return !!(probe.getContext('webgl2') || probe.getContext('webgl'));
  }
  try {
    if (!hasWebGL()) throw new Error('none');
    gl = start();
    buildCell();
    home();
    resize();
    window.addEventListener('resize', resize);
    let down = null;
    gl.renderer.domElement.addEventListener('mousedown', function (event) { down = [event.clientX, event.clientY]; place.focus(); });
    gl.renderer.domElement.addEventListener('mouseup', function (event) {
      if (down && Math.hypot(event.clientX - down[0], event.clientY - down[1]) < 4) clicked(event);
    });
  } catch (error) {
    gl = null;
    place.textContent = 'This browser has no WebGL: no picture, but the text beside it follows the time all the same.';
  }
  function fromHash() {
    const match = /^#seed-(\d+)(?:-pick-(\d+))?$/.exec(location.hash);
    if (!match || !open(match[1])) return;
    const look = replay.looks.find(function (l) { return l.pick === Number(match[2]); });
    if (look) seek(look.t + 0.001);
    document.getElementById('replay').scrollIntoView();
  }
  window.addEventListener('hashchange', fromHash);
  open(select.value);
  fromHash();
  window.binpickReplay = { seek: seek, open: open, play: play, pick: pickEstimate,
    state: function () { return { now: now, seed: replay.seed, picked: picked, webgl: !!gl, look: shownLook ? shownLook.pick : -1 }; } };
})();
