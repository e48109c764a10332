# SPDX-License-Identifier: Apache-2.0
"""A web server on the loopback interface with faults, which the first part of a path names; it keeps a log of all requests."""
import email.utils, hashlib, http.server, pathlib, threading, time, urllib.parse

# Faults: cut (the first answer for a file breaks off in the middle), noranges (each answer is whole), norangescut (both), wrongrange
# (continuations state another range), short (less than stated, and no more), slow (a piece every 20 ms), busy (twice 503), altered (one
# byte is another), tofile (redirects to a file of this machine), redirect (redirects to the file), page (an error page with status 200).


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def log_message(self, *_): pass

    def do_HEAD(self): self.answer(False)
    def do_GET(self): self.answer(True)

    def answer(self, sends):
        server, path = self.server, self.path.split("?")[0]
        _, fault, *name = path.split("/", 2)
        name = name[0] if name else ""
        if not name: return self.list_objects(sends)
        count = server.seen[path] = server.seen.get(path, 0) + 1
        entry = {"path": path, "query": self.path[len(path):], "range": self.headers.get("Range"), "sent": 0}
        server.log.append(entry)
        file = server.root / name
        if fault in ("tofile", "redirect"):
            return self.head(302, {"Location": file.as_uri() if fault == "tofile" else "/plain/" + name, "Content-Length": 0})
        if fault == "busy" and count < 3: return self.head(503, {"Content-Length": 0})
        if not file.is_file(): return self.head(404, {"Content-Length": 0})
        data = file.read_bytes()
        if fault == "page": data = b"<!DOCTYPE html><html>please log in</html>"
        if fault == "altered": data = data[:len(data) // 2] + bytes([data[len(data) // 2] ^ 1]) + data[len(data) // 2 + 1:]
        self.send_file(data, fault, count, entry, sends)

    def list_objects(self, sends):
        """Answers what rclone asks of a bucket: the objects of a prefix."""
        asked = urllib.parse.parse_qs(urllib.parse.urlsplit(self.path).query)
        files = [f for f in self.server.root.iterdir() if f.is_file() and f.name.startswith(asked.get("prefix", [""])[0])]
        objects = "".join(f"<Contents><Key>{f.name}</Key><LastModified>1970-01-01T00:00:00.000Z</LastModified><ETag>&quot;0&quot;</ETag>"
                          f"<Size>{f.stat().st_size}</Size></Contents>" for f in files)
        text = (f'<?xml version="1.0"?><ListBucketResult><KeyCount>{len(files)}</KeyCount><IsTruncated>false</IsTruncated>{objects}'
                "</ListBucketResult>").encode()
        self.head(200, {"Content-Type": "application/xml", "Content-Length": len(text)})
        if sends: self.wfile.write(text)

    def send_file(self, data, fault, count, entry, sends):
        fields = {"ETag": f'"{hashlib.md5(data).hexdigest()}"', "Last-Modified": email.utils.formatdate(0, usegmt=True)}
        first, last, asked = 0, len(data) - 1, self.headers.get("Range")
        part = asked is not None and not fault.startswith("noranges")
        if part:
            begin, end = asked.removeprefix("bytes=").split("-")
            first, last = int(begin), min(int(end), last) if end else last
            shift = 1 if fault == "wrongrange" and first else 0
            fields["Content-Range"] = f"bytes {first + shift}-{last + shift if not shift else last}/{len(data)}"
        body = data[first:last + 1]
        fields["Content-Length"] = len(body)
        if fault == "short": body = b"" if first else body[:len(body) // 2]
        if fault in ("cut", "wrongrange", "norangescut") and count == 1: body = body[:len(body) // 2]
        self.head(206 if part else 200, fields)
        if not sends: return
        step = max(1, len(body) // 40) if fault == "slow" else max(1, len(body))
        for at in range(0, len(body), step):
            if fault == "slow": time.sleep(0.02)
            self.wfile.write(body[at:at + step])
            entry["sent"] += len(body[at:at + step])
        if len(body) < fields["Content-Length"]: self.close_connection = True

    def head(self, status, fields):
        self.send_response(status)
        for name, value in fields.items(): self.send_header(name, str(value))
        self.end_headers()


class FaultServer:
    """Serves the files below a folder; with `with`."""
    def __init__(self, root):
        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.server.daemon_threads = True
        self.server.root, self.server.log, self.server.seen = pathlib.Path(root), [], {}

    def __enter__(self):
        threading.Thread(target=self.server.serve_forever, daemon=True).start()
        return self

    def __exit__(self, *_): self.server.shutdown()

    @property
    def port(self): return self.server.server_port

    def address(self, fault, name=""): return f"http://127.0.0.1:{self.port}/{fault}/{name}"

    def taken(self):
        """The requests since the last call."""
        log, self.server.log, self.server.seen = self.server.log, [], {}
        return log
