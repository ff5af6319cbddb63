// The bytes that stand in the page as base64 of raw deflate.
"use strict";
{
  /** Whether this browser can unpack them. */
  qddotReport.canInflate = () => {
    try {
      return Boolean(new DecompressionStream("deflate-raw"));
    } catch {
      return false;
    }
  };

  /** The bytes of a blob by its id; rejects where it cannot be unpacked. Who needs them again keeps
      what it makes of them. */
  qddotReport.bytes = async (id) => {
    const text = atob(qddotReport.byId(id).textContent.trim());
    const packed = Uint8Array.from(text, (character) => character.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  };
}
