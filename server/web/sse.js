// Server-sent events (WHATWG HTML Living Standard, 9.2.6), read through fetch, which can send a
// token where EventSource cannot.

/// Takes text as it comes and gives the events that are whole.
export function eventParser() {
  let rest = '', event = {type: 'message', data: []}, id = '';
  return text => {
    const lines = (rest + text).split(/\r\n|\n|\r/);
    rest = lines.pop();
    const events = [];
    for (const line of lines) {
      if (line === '') {
        if (event.data.length > 0)
          events.push({type: event.type, data: event.data.join('\n'), id});
        event = {type: 'message', data: []};
        continue;
      }
      const colon = line.indexOf(':');
      if (colon === 0) continue;
      const field = colon < 0 ? line : line.slice(0, colon);
      const value = colon < 0 ? '' : line.slice(colon + 1).replace(/^ /, '');
      if (field === 'event') event.type = value;
      if (field === 'data') event.data.push(value);
      if (field === 'id') id = value;
    }
    return events;
  };
}

/// The events of a response, their data read as JSON.
export async function* readEvents(response) {
  const parse = eventParser();
  const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
  try {
    for (;;) {
      const {value, done} = await reader.read();
      if (done) return;
      for (const event of parse(value)) yield {...event, data: JSON.parse(event.data)};
    }
  } finally {
    reader.cancel().catch(() => {});
  }
}
