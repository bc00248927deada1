# One emulated OEM6250 on TCP port 6250; build it in the repository: docker build -t oem6250 .
FROM python:3.11-slim AS build
WORKDIR /src
COPY pyproject.toml README.md LICENSE ./
COPY protocol protocol
COPY emulator emulator
COPY clients clients
RUN python -m venv /opt/oem6250 && /opt/oem6250/bin/pip install --no-cache-dir .

FROM python:3.11-slim
COPY --from=build /opt/oem6250 /opt/oem6250
RUN useradd --system --uid 6250 oem6250 \
    && install -d -o oem6250 -g oem6250 /var/lib/oem6250 /var/cache/oem6250
ENV PATH=/opt/oem6250/bin:$PATH OEM6250_CACHE_DIR=/var/cache/oem6250
USER oem6250
WORKDIR /var/lib/oem6250
# Compiles the servo kernel for the processor of this machine; on another one the first start does it again.
RUN python -c "from emulator import Emulator; Emulator()"
VOLUME ["/var/lib/oem6250", "/var/cache/oem6250"]
EXPOSE 6250
ENTRYPOINT ["oem6250"]
CMD ["serve", "--tcp", "0.0.0.0:6250", "--allow-remote", "--pty", "none", "--state", "/var/lib/oem6250/unit.state"]
