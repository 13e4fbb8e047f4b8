/** Bytes that stand in the page as base64, in an element that no browser runs. */
export function bytesOfBlock(block: Element): Uint8Array<ArrayBuffer> {
  const text = atob(block.textContent!.trim());
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}
