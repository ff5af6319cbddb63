// Two views of one camera on one canvas: the reference and the chosen run.
"use strict";
{
  const ANGLE = 32;
  const MARGIN = 1.12;
  const MOST_PIXELS_A_PIXEL = 2;

  /** Along which axis a flat scene is looked at: the one in which it extends least. */
  function thinnestAxis({ low, high }) {
    const extents = [0, 1, 2].map((axis) => high[axis] - low[axis]);
    return extents.indexOf(Math.min(...extents));
  }

  /** How far from the middle of a box a camera in the direction `from` sees all of its corners. */
  function distanceToSee({ low, high }, middle, from, aspect) {
    const right = new THREE.Vector3(0, 0, 1).cross(from).normalize();
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

  function camera(flat) {
    return flat
      ? new THREE.OrthographicCamera(-1, 1, 1, -1, -1, 1)
      : new THREE.PerspectiveCamera(ANGLE, 1);
  }

  /** A stage, made once for the page; throws where there is no WebGL. show(holder, places, bodies)
      puts its canvas behind the elements `places` of the holder and draws a body into each;
      `lost(gone)` hears when the browser takes WebGL away and gives it back. */
  qddotReport.motionStage = (dimension, lost) => {
    const canvas = document.createElement("canvas");
    canvas.setAttribute("role", "img");
    // Where a pixel of the page is several of the screen, edges are smooth enough without more
    // work.
    const renderer = new THREE.WebGLRenderer({
      canvas,
      antialias: devicePixelRatio < MOST_PIXELS_A_PIXEL,
      alpha: true,
    });
    renderer.setClearColor(0xffffff, 1);
    renderer.setScissorTest(true);
    const flat = dimension < 3;
    const eye = camera(flat);
    eye.up.set(0, 0, 1);
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
    let bounds = { low: [-1, -1, -1], high: [1, 1, 1] };
    let holder = null;
    let places = [];
    let bodies = [];
    let asked = false;

    /** Puts the camera where it sees all of the bounds. */
    function look(newBounds) {
      bounds = newBounds;
      const middle = new THREE.Vector3(
        ...bounds.low.map((low, axis) => (low + bounds.high[axis]) / 2),
      );
      const radius = Math.hypot(...bounds.low.map((low, axis) => bounds.high[axis] - low)) / 2 || 1;
      controls.target.copy(middle);
      if (flat) {
        const axis = thinnestAxis(bounds);
        const from = new THREE.Vector3(axis === 0 ? 1 : 0, axis === 1 ? -1 : 0, axis === 2 ? 1 : 0);
        eye.up.set(0, axis === 2 ? 1 : 0, axis === 2 ? 0 : 1);
        eye.position.copy(middle).addScaledVector(from, 2 * radius);
        [eye.near, eye.far, eye.zoom] = [0.01 * radius, 100 * radius, 1];
      } else {
        const from = new THREE.Vector3(0.62, -1, 0.5).normalize();
        const aspect = places[0] ? places[0].clientWidth / places[0].clientHeight : 1;
        const away = distanceToSee(bounds, middle, from, aspect);
        eye.position.copy(middle).addScaledVector(from, away);
        [eye.near, eye.far] = [away / 200, away * 20];
      }
      controls.update();
      draw();
    }

    function fit(width, height) {
      if (!flat) {
        eye.aspect = width / height;
      } else {
        const axis = thinnestAxis(bounds);
        const across = axis === 0 ? 1 : 0;
        const up = axis === 2 ? 1 : 2;
        const wide = 1.16 * (bounds.high[across] - bounds.low[across]);
        const high = 1.16 * (bounds.high[up] - bounds.low[up]);
        const half = Math.max(high, (wide * height) / width, 1e-30) / 2;
        [eye.top, eye.bottom] = [half, -half];
        [eye.right, eye.left] = [(half * width) / height, (-half * width) / height];
      }
      eye.updateProjectionMatrix();
    }

    function drawNow() {
      asked = false;
      const { width, height } = holder.getBoundingClientRect();
      if (!width || !height) return;
      const ratio = Math.min(devicePixelRatio, MOST_PIXELS_A_PIXEL);
      if (
        canvas.width !== Math.floor(width * ratio) ||
        canvas.height !== Math.floor(height * ratio)
      ) {
        renderer.setPixelRatio(ratio);
        renderer.setSize(width, height);
      }
      places.forEach((place, index) => {
        const [x, y] = [
          place.offsetLeft + 1,
          holder.clientHeight - place.offsetTop - place.clientHeight - 1,
        ];
        renderer.setViewport(x, y, place.clientWidth, place.clientHeight);
        renderer.setScissor(x, y, place.clientWidth, place.clientHeight);
        fit(place.clientWidth, place.clientHeight);
        renderer.render(bodies[index].scene, eye);
      });
      holder.dataset.draws = Number(holder.dataset.draws ?? 0) + 1;
    }

    /** Draws at the next frame of the screen. */
    function draw() {
      if (asked) return;
      asked = true;
      requestAnimationFrame(drawNow);
    }

    function show(newHolder, newPlaces, newBodies) {
      for (const body of bodies) body.dispose();
      resized.disconnect();
      [holder, places, bodies] = [newHolder, newPlaces, newBodies];
      holder.append(canvas);
      resized.observe(holder);
      draw();
    }

    /** Draws at once and lays a still picture over the views, for paper, which would show the last
        frame of the screen; or takes the picture away. */
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
      if (flat) eye.zoom *= factor;
      else eye.position.sub(controls.target).divideScalar(factor).add(controls.target);
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
  };
}
