// The bytes that stand in the page as base64 of raw deflate.
"use strict";
{
  const kept = new Map();

  /** Whether this browser can unpack them. */
  qddotReport.canInflate = () => {
    try {
      return Boolean(new DecompressionStream("deflate-raw"));
    } catch {
      return false;
    }
  };

  async function inflate(id) {
    const text = atob(qddotReport.byId(id).textContent.trim());
    const packed = Uint8Array.from(text, (character) => character.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  }

  /** The bytes of a blob by its id; unpacked when first asked for. */
  qddotReport.bytes = (id) => {
    if (!kept.has(id)) kept.set(id, inflate(id));
    return kept.get(id);
  };
}
