import assert from 'node:assert/strict';
import test from 'node:test';

import {eventParser} from '../../../server/web/sse.js';

const text = 'retry: 2000\n\nid: 1\nevent: state\ndata: {"a":1}\n\n: still here\n\n' +
    'event: preview\ndata: {"samples":4}\n\nid: 2\nevent: progress\ndata: {}\n\n';

test('events are whole however the text is cut', () => {
  for (const size of [1, 2, 7, 1000]) {
    const parse = eventParser();
    const events = [];
    for (let i = 0; i < text.length; i += size) events.push(...parse(text.slice(i, i + size)));
    assert.deepEqual(events, [
      {type: 'state', data: '{"a":1}', id: '1'},
      {type: 'preview', data: '{"samples":4}', id: '1'},
      {type: 'progress', data: '{}', id: '2'},
    ]);
  }
});
