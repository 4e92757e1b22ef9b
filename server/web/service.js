// The calls of the service that the page makes.

import {readEvents} from './sse.js';

/// An answer that refuses: RFC 9457, or what comes closest to it.
export class Problem extends Error {
  constructor(status, body) {
    super(body.detail || body.title || `The service answered ${status}.`);
    this.status = status;
    this.title = body.title ?? '';
    this.type = body.type ?? '';
    this.errors = Array.isArray(body.errors) ? body.errors : [];
  }
}

const tokenKey = 'translucube-token';
const ended = new Set(['succeeded', 'failed', 'canceled']);

export function hasEnded(state) {
  return ended.has(state);
}

export class Service {
  #askToken;
  #asking = null;

  /// `askToken` resolves to what the user gave, '' for nothing.
  constructor(askToken) {
    this.#askToken = askToken;
  }

  get hasToken() {
    return sessionStorage.getItem(tokenKey) !== null;
  }

  /// The response, whatever its format; throws Problem. Asks for a token where one is needed.
  async call(path, {method = 'GET', body, headers = {}, signal} = {}) {
    for (;;) {
      const token = sessionStorage.getItem(tokenKey);
      const response = await fetch(path, {
        method, signal, cache: 'no-cache',
        headers: {
          ...headers,
          ...(body === undefined ? {} : {'Content-Type': 'application/json'}),
          ...(token ? {Authorization: `Bearer ${token}`} : {}),
        },
        body: body === undefined ? undefined : JSON.stringify(body),
      });
      if (response.ok) return response;
      if (response.status === 401) {
        // Another call may have been given one meanwhile.
        if (token !== sessionStorage.getItem(tokenKey) || await this.#newToken()) continue;
      }
      throw new Problem(response.status, await response.json().catch(() => ({})));
    }
  }

  async json(path, options) {
    return (await this.call(path, options)).json();
  }

  post(path, body, options = {}) {
    return this.json(path, {...options, method: 'POST', body});
  }

  /// `onEvent({type, data})` for each event until the render or sweep has ended; connects again
  /// where the connection breaks.
  async follow(path, {signal, onEvent}) {
    for (let last = '';;) {
      const headers = last ? {'Last-Event-ID': last} : {};
      try {
        const response = await this.call(path, {headers, signal});
        if (response.status === 204) return;
        for await (const event of readEvents(response)) {
          if (event.id) last = event.id;
          onEvent(event);
          if (event.type === 'state' && hasEnded(event.data.state)) return;
        }
      } catch (error) {
        if (signal?.aborted || (error instanceof Problem && error.status < 500)) throw error;
      }
      await new Promise(resolve => setTimeout(resolve, 1000));
    }
  }

  /// Nobody waits for it; what is being traced ends at once.
  remove(id) {
    this.call(`/v1/renders/${id}`, {method: 'DELETE'}).catch(() => {});
  }

  /// False where the user gives none. One question for all calls that wait for it.
  #newToken() {
    this.#asking ??= this.#askToken().then(token => {
      this.#asking = null;
      if (token) sessionStorage.setItem(tokenKey, token);
      return token !== '';
    });
    return this.#asking;
  }
}
