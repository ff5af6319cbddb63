// A scene as three.js draws it: springs as lines, faces shaded, nodes as points where they are few.
"use strict";
{
  const FEW_NODES = 300;
  // Thick lines cost a rectangle each; where there are many springs, thin ones show more anyway.
  const FEW_SPRINGS = 3000;
  const PINNED = 0x222222;

  function discTexture() {
    const canvas = document.createElement("canvas");
    canvas.width = canvas.height = 64;
    const pen = canvas.getContext("2d");
    pen.fillStyle = "#fff";
    pen.beginPath();
    pen.arc(32, 32, 30, 0, 2 * Math.PI);
    pen.fill();
    return new THREE.CanvasTexture(canvas);
  }

  function dynamic(values, size) {
    const attribute = new THREE.BufferAttribute(values, size);
    attribute.setUsage(THREE.DynamicDrawUsage);
    return attribute;
  }

  function nodeGeometry(attributes, index) {
    const geometry = new THREE.BufferGeometry();
    for (const [name, attribute] of Object.entries(attributes))
      geometry.setAttribute(name, attribute);
    if (index) geometry.setIndex(new THREE.BufferAttribute(index, 1));
    return geometry;
  }

  /** Lines of some pixels' width between pairs of nodes: the ends are copied at each change. */
  function thickLines(springs, width, color) {
    const geometry = new THREE.LineSegmentsGeometry();
    geometry.setPositions(new Float32Array(3 * springs.length));
    geometry.setColors(new Float32Array(3 * springs.length));
    const lines = new THREE.LineSegments2(
      geometry,
      new THREE.LineMaterial({ linewidth: width, vertexColors: true, color }),
    );
    const copy = (attribute, values) => {
      const { array } = attribute.data;
      springs.forEach((node, end) => array.set(values.subarray(3 * node, 3 * node + 3), 3 * end));
      attribute.data.needsUpdate = true;
    };
    lines.userData.update = (positions, colors) => {
      copy(geometry.attributes.instanceStart, positions);
      copy(geometry.attributes.instanceColorStart, colors);
    };
    return lines;
  }

  /** The body of `nodes` nodes; update(positions, colors) moves and colours it (both nodes x 3). */
  qddotReport.motionBody = ({ nodes, springs, faces, pinned }) => {
    const scene = new THREE.Scene();
    const positions = new Float32Array(3 * nodes);
    const colors = new Float32Array(3 * nodes);
    const attributes = { position: dynamic(positions, 3), color: dynamic(colors, 3) };
    const parts = [];

    if (faces.length) {
      const skin = new THREE.MeshLambertMaterial({
        vertexColors: true,
        side: THREE.DoubleSide,
        flatShading: true,
        polygonOffset: true,
        polygonOffsetFactor: 1,
        polygonOffsetUnits: 1,
      });
      parts.push(new THREE.Mesh(nodeGeometry(attributes, faces), skin));
      const sun = new THREE.DirectionalLight(0xffffff, 1.6);
      sun.position.set(-0.4, -0.7, 1);
      scene.add(new THREE.AmbientLight(0xffffff, 1.9), sun);
    }
    // Springs are darker than the faces below them, so that the weave is visible.
    const shade = faces.length ? 0x777777 : 0xffffff;
    if (springs.length && springs.length <= 2 * FEW_SPRINGS) {
      parts.push(
        thickLines(springs, faces.length ? 1.2 : springs.length <= 600 ? 2.6 : 1.5, shade),
      );
    } else if (springs.length) {
      const thin = new THREE.LineBasicMaterial({
        vertexColors: true,
        color: shade,
        transparent: faces.length > 0,
        opacity: faces.length ? 0.35 : 1,
      });
      parts.push(new THREE.LineSegments(nodeGeometry(attributes, springs), thin));
    }
    const disc = discTexture();
    if (nodes <= FEW_NODES || !springs.length) {
      const size = nodes <= 40 ? 13 : nodes <= FEW_NODES ? 7 : 3;
      const dots = new THREE.PointsMaterial({
        size,
        sizeAttenuation: false,
        vertexColors: true,
        map: disc,
        alphaTest: 0.5,
      });
      parts.push(new THREE.Points(nodeGeometry(attributes), dots));
    }
    if (pinned.length) {
      const size = nodes <= FEW_NODES ? 11 : 5;
      const squares = new THREE.PointsMaterial({ size, sizeAttenuation: false, color: PINNED });
      parts.push(
        new THREE.Points(
          nodeGeometry({ position: attributes.position }, Uint32Array.from(pinned)),
          squares,
        ),
      );
    }
    for (const part of parts) {
      // Bounds of what moves would have to be found anew for each frame.
      part.frustumCulled = false;
      scene.add(part);
    }

    function update() {
      attributes.position.needsUpdate = true;
      attributes.color.needsUpdate = true;
      for (const part of parts) part.userData.update?.(positions, colors);
    }

    function dispose() {
      disc.dispose();
      for (const part of parts) {
        part.geometry.dispose();
        part.material.dispose();
      }
    }

    return { scene, positions, colors, update, dispose };
  };
}
