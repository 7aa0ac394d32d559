# robobt with everything, on the CPU: docker build -t robobt . && docker run --rm robobt make test
FROM python:3.11-slim
RUN apt-get update \
    && apt-get install -y --no-install-recommends make git chromium chromium-driver \
    && rm -rf /var/lib/apt/lists/*
WORKDIR /robobt
COPY . .
# PyTorch first and from its own index, where the builds are without CUDA.
RUN python -m venv .venv \
    && .venv/bin/pip install --no-cache-dir -c constraints.txt torch --index-url https://download.pytorch.org/whl/cpu \
    && make install
ENV PATH=/robobt/.venv/bin:$PATH
CMD ["robobt", "--help"]
