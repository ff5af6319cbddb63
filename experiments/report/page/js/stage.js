// A scene as three.js draws it, and views of one camera on one canvas: the reference, the chosen run
// and those beside it, each by itself or all in one.

// In degrees: the camera's angle of view.
const ANGLE = 32;
const MARGIN = 1.12;
const MOST_PIXELS_A_PIXEL = 2;
const FEW_NODES = 300;
// Thick lines cost a rectangle each; where there are many springs, thin ones show more anyway.
const FEW_SPRINGS = 3000;
const PINNED = 0x222222;

function discTexture() {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 64;
  const pen = canvas.getContext("2d");
  pen.fillStyle = "#fff";
  pen.arc(32, 32, 30, 0, 2 * Math.PI);
  pen.fill();
  return new THREE.CanvasTexture(canvas);
}

// Lines of some pixels' width between pairs of nodes: the ends of those shown are copied at each
// change.
function thickLines(springs, width, color) {
  const geometry = new THREE.LineSegmentsGeometry();
  geometry.setPositions(new Float32Array(3 * springs.length));
  geometry.setColors(new Float32Array(3 * springs.length));
  const lines = new THREE.LineSegments2(
    geometry,
    new THREE.LineMaterial({ linewidth: width, vertexColors: true, color }),
  );
  const copy = ({ data }, values, shown) => {
    shown.forEach((node, end) =>
      data.array.set(values.subarray(3 * node, 3 * node + 3), 3 * end),
    );
    data.needsUpdate = true;
  };
  lines.userData.update = (shown, positions, colors) => {
    geometry.instanceCount = shown.length / 2;
    copy(geometry.attributes.instanceStart, positions, shown);
    copy(geometry.attributes.instanceColorStart, colors, shown);
  };
  return lines;
}

// Thin lines between pairs of nodes, by an index of their own: springs are of several bodies.
function thinLines(geometry, look) {
  const lines = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial(look));
  lines.userData.update = (shown) => {
    // Springs that break stay broken: as many are the same ones.
    if (shown.length === geometry.drawRange.count) return;
    geometry.index.array.set(shown);
    geometry.index.needsUpdate = true;
    geometry.setDrawRange(0, shown.length);
  };
  return lines;
}

/** The direction of `up` [1], or that of the z axis where there is none. */
const upwards = (up) => (up ? new THREE.Vector3(...up) : new THREE.Vector3(0, 0, 1));

// Turns a direction that is told for z upwards.
function turned(direction, up) {
  const [z, to] = [new THREE.Vector3(0, 0, 1), upwards(up)];
  const axis = z.clone().cross(to);
  // Upside down, any axis across will do.
  if (axis.length() === 0) axis.set(1, 0, 0);
  return direction.applyAxisAngle(axis.normalize(), z.angleTo(to));
}

/** The body of `nodes` nodes: springs as lines, faces shaded, nodes as points where they are few;
    update(shown) draws its positions and colours (both nodes x 3) from then on, with the springs
    shown. */
export function bodyOf({ nodes, springs, faces, pinned, up }) {
  const scene = new THREE.Scene();
  const positions = new Float32Array(3 * nodes);
  const colors = new Float32Array(3 * nodes);
  const [position, color] = [positions, colors].map((values) =>
    new THREE.BufferAttribute(values, 3).setUsage(THREE.DynamicDrawUsage),
  );
  const geometry = (index) => {
    const made = new THREE.BufferGeometry();
    made.setAttribute("position", position).setAttribute("color", color);
    return index ? made.setIndex(new THREE.BufferAttribute(index, 1)) : made;
  };
  const hasFaces = faces.length > 0;
  const parts = [];

  if (hasFaces) {
    const skin = new THREE.MeshLambertMaterial({
      vertexColors: true,
      side: THREE.DoubleSide,
      flatShading: true,
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
    });
    parts.push(new THREE.Mesh(geometry(faces), skin));
    const sun = new THREE.DirectionalLight(0xffffff, 1.6);
    sun.position.copy(turned(new THREE.Vector3(-0.4, -0.7, 1), up));
    scene.add(new THREE.AmbientLight(0xffffff, 1.9), sun);
  }
  // Springs are darker than the faces below them, so that the weave is visible.
  const shade = hasFaces ? 0x777777 : 0xffffff;
  if (springs.length > 2 * FEW_SPRINGS) {
    const look = {
      vertexColors: true,
      color: shade,
      transparent: hasFaces,
      opacity: hasFaces ? 0.35 : 1,
    };
    parts.push(thinLines(geometry(springs.slice()), look));
  } else if (springs.length) {
    parts.push(thickLines(springs, hasFaces ? 1.2 : springs.length <= 600 ? 2.6 : 1.5, shade));
  }
  const dots = (size, look, index) =>
    new THREE.Points(
      geometry(index),
      new THREE.PointsMaterial({ size, sizeAttenuation: false, ...look }),
    );
  const disc = discTexture();
  if (nodes <= FEW_NODES || !springs.length) {
    const size = nodes <= 40 ? 13 : nodes <= FEW_NODES ? 7 : 3;
    parts.push(dots(size, { vertexColors: true, map: disc, alphaTest: 0.5 }));
  }
  if (pinned.length)
    parts.push(dots(nodes <= FEW_NODES ? 11 : 5, { color: PINNED }, Uint32Array.from(pinned)));
  // Bounds of what moves would have to be found anew for each frame.
  for (const part of parts) part.frustumCulled = false;
  scene.add(...parts);

  function update(shown) {
    position.needsUpdate = true;
    color.needsUpdate = true;
    for (const part of parts) part.userData.update?.(shown, positions, colors);
  }

  function dispose() {
    disc.dispose();
    for (const part of parts) {
      part.geometry.dispose();
      part.material.dispose();
    }
  }

  return { scene, positions, colors, update, dispose };
}

// The direction from which a flat scene is looked at: along the axis in which it extends least, but
// not along the one that is upwards.
function acrossPlane({ low, high }, up) {
  const isUpwards = (axis) => up && Math.abs(up[axis]) > 0.1;
  const extents = high.map((end, axis) => (isUpwards(axis) ? Infinity : end - low[axis]));
  const axis = extents.indexOf(Math.min(...extents));
  return new THREE.Vector3().setComponent(axis, axis === 1 ? -1 : 1);
}

// The distance from the middle of a box at which a camera in the direction `from` sees all of it.
function distanceToSee({ low, high }, middle, from, upwards, aspect) {
  const right = upwards.clone().cross(from).normalize();
  const up = from.clone().cross(right);
  const slope = Math.tan((ANGLE * Math.PI) / 360) / MARGIN;
  let away = 1e-30;
  for (let corner = 0; corner < 8; corner++) {
    const place = new THREE.Vector3(
      ...[0, 1, 2].map((axis) => (corner & (1 << axis) ? high : low)[axis]),
    ).sub(middle);
    const wide = Math.max(Math.abs(place.dot(up)), Math.abs(place.dot(right)) / aspect);
    away = Math.max(away, place.dot(from) + wide / slope);
  }
  return away;
}

/** A stage, made once for the page; throws where there is no WebGL. `up`: the unit vector against
    gravity, or null. show(holder, places, groups) puts its canvas behind the elements `places` of
    the holder and draws a group of bodies into each; `lost(gone)` hears when the browser takes WebGL
    away and gives it back. */
export function stageOf({ dimension, up }, lost) {
  const canvas = document.createElement("canvas");
  canvas.setAttribute("role", "img");
  // Edges need no more work where a pixel of the page is several of the screen.
  const antialias = devicePixelRatio < MOST_PIXELS_A_PIXEL;
  const renderer = new THREE.WebGLRenderer({ canvas, antialias, alpha: true });
  renderer.setClearColor(0xffffff, 1);
  renderer.setScissorTest(true);
  const flat = dimension < 3;
  const eye = new THREE.PerspectiveCamera(ANGLE);
  // The controls turn around the direction that is upwards when they are made.
  eye.up.copy(upwards(up));
  const controls = new THREE.OrbitControls(eye, canvas);
  controls.enableDamping = false;
  controls.enableRotate = !flat;
  controls.screenSpacePanning = true;
  // The wheel and a finger up or down go on scrolling the page; a click on the view gives it the
  // wheel.
  controls.enableZoom = false;
  canvas.style.touchAction = "pan-y";
  canvas.addEventListener("pointerdown", () => (controls.enableZoom = true));
  canvas.addEventListener("pointerleave", (event) => {
    if (event.pointerType === "mouse") controls.enableZoom = false;
  });
  // Width by height of a view that shows the whole scene.
  let aspect = 1;
  let holder = null;
  let places = [];
  let groups = [];
  let asked = false;

  // Puts the camera where it sees all of the bounds.
  function look(bounds) {
    const middle = new THREE.Vector3(...bounds.low.map((low, i) => (low + bounds.high[i]) / 2));
    const from = flat
      ? acrossPlane(bounds, up)
      : turned(new THREE.Vector3(0.62, -1, 0.5).normalize(), up);
    if (up) eye.up.copy(upwards(up));
    else eye.up.set(0, from.z === 1 ? 1 : 0, from.z === 1 ? 0 : 1);
    aspect = places[0].clientWidth / places[0].clientHeight;
    const away = distanceToSee(bounds, middle, from, eye.up, aspect);
    controls.target.copy(middle);
    eye.position.copy(middle).addScaledVector(from, away);
    [eye.near, eye.far] = [away / 200, away * 20];
    controls.update();
    draw();
  }

  function drawNow() {
    asked = false;
    const { width, height } = holder.getBoundingClientRect();
    if (!width || !height) return;
    const ratio = Math.min(devicePixelRatio, MOST_PIXELS_A_PIXEL);
    const [wide, high] = [width, height].map((length) => Math.floor(length * ratio));
    if (canvas.width !== wide || canvas.height !== high) {
      renderer.setPixelRatio(ratio);
      renderer.setSize(width, height);
    }
    places.forEach(({ offsetLeft, offsetTop, clientWidth, clientHeight }, index) => {
      const corner = [offsetLeft + 1, holder.clientHeight - offsetTop - clientHeight - 1];
      renderer.setViewport(...corner, clientWidth, clientHeight);
      renderer.setScissor(...corner, clientWidth, clientHeight);
      // A view of another shape shows no less when it is narrower.
      eye.aspect = clientWidth / clientHeight;
      eye.zoom = Math.min(1, eye.aspect / aspect);
      eye.updateProjectionMatrix();
      groups[index].forEach((body, nth) => {
        renderer.autoClear = nth === 0;
        renderer.render(body.scene, eye);
      });
    });
    holder.dataset.draws = Number(holder.dataset.draws ?? 0) + 1;
  }

  // Draws at the next frame of the screen.
  function draw() {
    if (asked) return;
    asked = true;
    requestAnimationFrame(drawNow);
  }

  function show(newHolder, newPlaces, newGroups) {
    for (const body of groups.flat()) body.dispose();
    resized.disconnect();
    [holder, places, groups] = [newHolder, newPlaces, newGroups];
    holder.append(canvas);
    resized.observe(holder);
    draw();
  }

  // Draws at once and lays a still picture over the views, for paper, which would show the last
  // frame of the screen; or takes the picture away.
  function still(wanted) {
    holder.querySelector(".still")?.remove();
    drawNow();
    if (!wanted) return;
    const picture = document.createElement("canvas");
    picture.className = "still";
    picture.style.cssText = canvas.style.cssText;
    [picture.width, picture.height] = [canvas.width, canvas.height];
    picture.getContext("2d").drawImage(canvas, 0, 0);
    holder.append(picture);
  }

  function zoom(factor) {
    eye.position.sub(controls.target).divideScalar(factor).add(controls.target);
    controls.update();
    draw();
  }

  canvas.addEventListener("webglcontextlost", (event) => {
    event.preventDefault();
    lost(true);
  });
  canvas.addEventListener("webglcontextrestored", () => {
    lost(false);
    draw();
  });
  controls.addEventListener("change", draw);
  const resized = new ResizeObserver(draw);
  return { canvas, show, look, draw, still, zoom };
}
