"""TLS in front of another of these servers, with certificates made here.

tls_front.py ca=FILE [cert=KIND] [fault=NAME] [shown=PREFIX] SCRIPT [argument...]

FILE gets the authority's certificate; PREFIX.pem and PREFIX.key what is shown, for other servers.
KIND is good (for localhost and 127.0.0.1), expired, early (not yet valid), elsewhere (for other hosts),
purpose (for clients only), stranger (signed by an authority that is not in FILE) or self (signed by
itself). Faults: `hang` never answers a handshake, `cut` ends connections without TLS's own end, `reset`
resets them right behind the handshake (with `alerts`), `mutual` and `mutual12` want a certificate of the
client (TLS 1.3 and 1.2), `old` speaks TLS 1.1; asyncio closes on a client that does not fit without
saying so, and with `alerts` the server says it.
"""
import asyncio
import ctypes
import datetime
import ipaddress
import os
import signal
import socket
import ssl
import struct
import subprocess
import sys
import tempfile
import threading
import time
import warnings

from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec

options, words = {}, sys.argv[1:]
while "=" in words[0]:
    name, value = words.pop(0).split("=", 1)
    options[name] = value

NOW = datetime.datetime.utcnow()
DAY = datetime.timedelta(days=1)


def named(name):
    return x509.Name([x509.NameAttribute(x509.NameOID.COMMON_NAME, name)])


def certificate(name, key, issuer, signer, begin=NOW - DAY, end=NOW + DAY, extensions=()):
    made = x509.CertificateBuilder().subject_name(named(name)).issuer_name(named(issuer)).public_key(
        key.public_key()).serial_number(x509.random_serial_number()).not_valid_before(
            begin).not_valid_after(end)
    for extension in extensions:
        made = made.add_extension(extension, critical=False)
    return made.sign(signer, hashes.SHA256())


def pem(thing):
    if isinstance(thing, x509.Certificate):
        return thing.public_bytes(serialization.Encoding.PEM)
    return thing.private_bytes(serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8,
                               serialization.NoEncryption())


def context():
    kind = options.get("cert", "good")
    authority, stranger, key = (ec.generate_private_key(ec.SECP256R1()) for _ in range(3))
    is_authority = [x509.BasicConstraints(ca=True, path_length=None)]
    with open(options["ca"], "wb") as file:
        file.write(pem(certificate("authority", authority, "authority", authority,
                                   extensions=is_authority)))
    begin, end = NOW - DAY, NOW + DAY
    if kind == "expired":
        begin, end = datetime.datetime(2020, 1, 1), datetime.datetime(2021, 5, 6, 7, 8)
    if kind == "early":
        begin, end = datetime.datetime(2120, 1, 1), datetime.datetime(2121, 1, 1)
    hosts = [x509.DNSName("localhost"), x509.IPAddress(ipaddress.ip_address("127.0.0.1"))]
    if kind == "elsewhere":
        hosts = [x509.DNSName("gpu.example"), x509.IPAddress(ipaddress.ip_address("10.1.2.3"))]
    extensions = [x509.SubjectAlternativeName(hosts)]
    if kind == "purpose":
        extensions.append(x509.ExtendedKeyUsage([x509.ExtendedKeyUsageOID.CLIENT_AUTH]))
    issuer, signer = {"stranger": ("stranger", stranger), "self": ("server", key)}.get(
        kind, ("authority", authority))
    shown = certificate("server", key, issuer, signer, begin, end, extensions)
    for end, thing in ((".pem", shown), (".key", key)) if "shown" in options else ():
        with open(options["shown"] + end, "wb") as file:
            file.write(pem(thing))
    made = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    with tempfile.NamedTemporaryFile() as file:
        file.write(pem(key) + pem(shown))
        file.flush()
        made.load_cert_chain(file.name)
    fault = options.get("fault", "")
    if fault.startswith("mutual"):
        made.verify_mode = ssl.CERT_REQUIRED
        made.load_verify_locations(options["ca"])
    if fault == "mutual12":
        made.maximum_version = ssl.TLSVersion.TLSv1_2
    if fault == "old":
        warnings.simplefilter("ignore")
        made.minimum_version = made.maximum_version = ssl.TLSVersion.TLSv1_1
        made.set_ciphers("DEFAULT:@SECLEVEL=0")
    return made


def die_with_parent():
    ctypes.CDLL(None).prctl(1, signal.SIGKILL)


async def pour(reader, writer):
    try:
        while data := await reader.read(1 << 16):
            writer.write(data)
            await writer.drain()
    except (ConnectionError, ssl.SSLError):
        pass


def alert(made):
    """Handshakes of a blocking socket, each ended with what is wrong."""
    listening = socket.create_server(("127.0.0.1", 0))
    print("port", listening.getsockname()[1], flush=True)
    os.close(1)

    def shake(connection):
        inside = made.wrap_socket(connection, server_side=True, do_handshake_on_connect=False)
        try:
            inside.do_handshake()
            inside.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            inside.close()  # with a reset, as where a client still sends
        except (OSError, ssl.SSLError):
            time.sleep(0.5)  # closed at once, what the client still sent would cut the connection
            inside.close()

    while True:
        threading.Thread(target=shake, args=listening.accept()[:1], daemon=True).start()


async def main():
    inner = subprocess.Popen(
        [sys.executable, "-u", os.path.join(os.path.dirname(__file__), words[0])] + words[1:],
        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
        preexec_fn=die_with_parent)
    port = int(inner.stdout.readline().split()[1])

    async def handle(reader, writer):
        if options.get("fault") == "hang":
            return await asyncio.sleep(60)
        inside, out = await asyncio.open_connection("127.0.0.1", port)
        tasks = [asyncio.create_task(pour(reader, out)), asyncio.create_task(pour(inside, writer))]
        await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        out.close()
        if options.get("fault") == "cut":
            writer.transport.abort()
        else:
            writer.close()

    made = context()  # also where it is not shown, for FILE
    if "alerts" in options:
        return alert(made)
    server = await asyncio.start_server(
        handle, "127.0.0.1", 0, ssl=None if options.get("fault") == "hang" else made)
    asyncio.get_running_loop().set_exception_handler(lambda loop, context: None)
    print("port", server.sockets[0].getsockname()[1], flush=True)
    os.close(1)
    await server.serve_forever()


asyncio.run(main())
